// An entry of the matrix that learns from the path and from the better half of the samples. Whoever includes it has the samples' `weights`,
// `normals` and `steps`, `push` with the rates, and says what PATH(d) is.

layout(std430, set = SEARCH_SET, binding = 7) readonly buffer Matrix { float matrix[]; };

float entry_after(uint row, uint column, uint samples) {
    precise float turned = 0.0;
    for (uint from = 0u; from < push.dofs; from += READ_AT_ONCE) {
        float entries[READ_AT_ONCE];
        for (uint nth = 0u; nth < READ_AT_ONCE; nth++) {
            entries[nth] = matrix[min(from + nth, push.dofs - 1u) * push.dofs + row];
        }
        for (uint nth = 0u; nth < READ_AT_ONCE; nth++) {
            if (from + nth < push.dofs) {
                precise float part = entries[nth] * PATH(from + nth);
                turned = turned + part;
            }
        }
    }
    precise float sum = 0.0;
    for (uint from = 0u; from < samples; from += READ_AT_ONCE) {
        float of_normals[READ_AT_ONCE];
        float of_steps[READ_AT_ONCE];
        for (uint nth = 0u; nth < READ_AT_ONCE; nth++) {
            uint place = min(from + nth, samples - 1u) * push.dofs;
            of_normals[nth] = normals[place + column];
            of_steps[nth] = steps[place + row];
        }
        for (uint nth = 0u; nth < READ_AT_ONCE; nth++) {
            float weight = from + nth < samples ? weights[from + nth] : 0.0;
            precise float normal = weight * of_normals[nth];
            precise float part = of_steps[nth] * normal;
            precise float more = sum + part;
            sum = weight == 0.0 ? sum : more;
        }
    }
    precise float along = push.of_path * (turned * PATH(column));
    precise float learnt = push.of_samples * sum;
    precise float entry = push.kept * matrix[column * push.dofs + row] + along + learnt;
    return entry;
}
