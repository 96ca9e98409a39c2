#version 450
#extension GL_GOOGLE_include_directive : require

// Weighted mean and deviation of one degree of freedom over rows, relative to the best pose. One workgroup a degree of freedom.

#include "search/constants.glsl"
#include "search/frame.glsl"
#include "search/outcome.glsl"

layout(local_size_x = SUM_LANES) in;

layout(std430, set = 0, binding = 2) readonly buffer Rows { float rows[]; };
layout(std430, set = 0, binding = 3) readonly buffer Weights { float weights[]; };
// A row a level. What stands still in a level, with a factor of 0, keeps its deviation.
layout(std430, set = 0, binding = 4) readonly buffer Factors { float factors[]; };

layout(push_constant) uniform Push {
    uint count;
    uint dofs;
    uint level;
} push;

shared float sums[SUM_LANES];

float sum_of_all(float own) {
    uint lane = gl_LocalInvocationID.x;
    sums[lane] = own;
    barrier();
    for (uint half_width = SUM_LANES / 2u; half_width > 0u; half_width /= 2u) {
        if (lane < half_width) {
            precise float both = sums[lane] + sums[lane + half_width];
            sums[lane] = both;
        }
        barrier();
    }
    float all = sums[0];
    barrier();
    return all;
}

void main() {
    uint d = gl_WorkGroupID.x;
    uint lane = gl_LocalInvocationID.x;
    float reference = outcome.values[d];
    precise float weight = 0.0;
    precise float sum = 0.0;
    for (uint row = lane; row < push.count; row += SUM_LANES) {
        weight = weight + weights[row];
        sum = sum + weights[row] * (rows[row * push.dofs + d] - reference);
    }
    float total = sum_of_all(weight);
    // Without a weight, which the host reports, the numbers stay sane for the evaluation that follows.
    float inverse = total > 0.0 ? reciprocal(total) : 0.0;
    precise float shift = sum_of_all(sum) * inverse;
    precise float square = 0.0;
    for (uint row = lane; row < push.count; row += SUM_LANES) {
        precise float off = (rows[row * push.dofs + d] - reference) - shift;
        precise float squared = off * off;
        square = square + weights[row] * squared;
    }
    precise float variance = sum_of_all(square) * inverse;
    if (lane == 0u) {
        precise float mean = reference + shift;
        if (factors[push.level * push.dofs + d] > 0.0) outcome.values[push.dofs + d] = root(variance);
        outcome.values[2u * push.dofs + d] = hold(mean, frame.values[2u * push.dofs + d], frame.values[3u * push.dofs + d]);
    }
}
