// The mean, path and step size that a generation leaves. Whoever includes it has the samples' `weights`, and `push` with the rates.

// Rows of a sample: its normal numbers, and its steps off the mean over the step size.
layout(std430, set = SEARCH_SET, binding = 5) readonly buffer Normals { float normals[]; };
layout(std430, set = SEARCH_SET, binding = 6) readonly buffer Steps { float steps[]; };

// The normal numbers and steps of all samples by their weights, of one degree of freedom. Those of no weight are read in vain.
vec2 weighed(uint d, uint samples) {
    precise float normal = 0.0;
    precise float step = 0.0;
    for (uint from = 0u; from < samples; from += READ_AT_ONCE) {
        float of_normals[READ_AT_ONCE];
        float of_steps[READ_AT_ONCE];
        for (uint nth = 0u; nth < READ_AT_ONCE; nth++) {
            uint place = min(from + nth, samples - 1u) * push.dofs + d;
            of_normals[nth] = normals[place];
            of_steps[nth] = steps[place];
        }
        for (uint nth = 0u; nth < READ_AT_ONCE; nth++) {
            float weight = from + nth < samples ? weights[from + nth] : 0.0;
            precise float more = normal + weight * of_normals[nth];
            precise float further = step + weight * of_steps[nth];
            normal = weight == 0.0 ? normal : more;
            step = weight == 0.0 ? step : further;
        }
    }
    return vec2(normal, step);
}

float path_after(uint d, float normal) {
    precise float longer = push.path_kept * evolution.values[push.dofs + d] + push.path_gain * normal;
    return longer;
}

float mean_after(uint d, float step, float sigma) {
    precise float mean = evolution.values[d] + sigma * step;
    return held_offset(mean, d, push.dofs);
}

// `square` is that of the path's length.
float sigma_after(float sigma, float square) {
    precise float change = push.sigma_gain * root(square) - push.sigma_loss;
    float capped = change <= 1.0 ? change : 1.0;
    float factor = capped > 0.0 ? reciprocal(exp_of_negative(-capped)) : exp_of_negative(capped);
    precise float next = sigma * factor;
    return hold(next, uintBitsToFloat(LEAST_SIGMA), uintBitsToFloat(MOST_SIGMA));
}

shared float squares[SUM_LANES];

// The sum over the invocations of a workgroup, in the order of a tree.
float sum_of_squares(float own) {
    uint lane = gl_LocalInvocationID.x;
    squares[lane] = own;
    barrier();
    for (uint half_width = SUM_LANES / 2u; half_width > 0u; half_width /= 2u) {
        if (lane < half_width) {
            precise float both = squares[lane] + squares[lane + half_width];
            squares[lane] = both;
        }
        barrier();
    }
    return squares[0];
}
