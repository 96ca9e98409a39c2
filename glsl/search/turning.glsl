// An entry of the matrix that learns from the path and from the better half of the samples. Whoever includes it has the samples' `weights`,
// `normals` and `steps`, `push` with the rates, and says what PATH(d) is.

layout(std430, set = SEARCH_SET, binding = 7) readonly buffer Matrix { float matrix[]; };

float entry_after(uint row, uint column, uint samples) {
    precise float turned = 0.0;
    for (uint d = 0u; d < push.dofs; d++) {
        precise float part = matrix[d * push.dofs + row] * PATH(d);
        turned = turned + part;
    }
    precise float sum = 0.0;
    for (uint sample_index = 0u; sample_index < samples; sample_index++) {
        float weight = weights[sample_index];
        if (weight == 0.0) continue;
        precise float normal = weight * normals[sample_index * push.dofs + column];
        precise float part = steps[sample_index * push.dofs + row] * normal;
        sum = sum + part;
    }
    precise float along = push.of_path * (turned * PATH(column));
    precise float learnt = push.of_samples * sum;
    precise float entry = push.kept * matrix[column * push.dofs + row] + along + learnt;
    return entry;
}
