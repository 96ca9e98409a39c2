#version 450
#extension GL_GOOGLE_include_directive : require

// What a generation teaches: the mean goes to its better half, the path follows, and the step size grows where the path is longer
// than chance makes it. Also the best sample so far. One workgroup.

#include "search/constants.glsl"
#include "search/frame.glsl"
#include "search/outcome.glsl"
#include "search/evolution.glsl"

layout(local_size_x = SUM_LANES) in;

layout(std430, set = 0, binding = 3) readonly buffer Fitness { float fitness[]; };
layout(std430, set = 0, binding = 4) readonly buffer Weights { float weights[]; };
layout(std430, set = 0, binding = 5) readonly buffer Normals { float normals[]; };
layout(std430, set = 0, binding = 6) readonly buffer Steps { float steps[]; };
layout(std430, set = 0, binding = 7) readonly buffer Positions { float positions[]; };
// What stands behind the fitness of every sample, and of the best one, a row of views each.
layout(std430, set = 0, binding = 8) readonly buffer Sums { uvec4 sums[]; };
layout(std430, set = 0, binding = 9) writeonly buffer BestSums { uvec4 best_sums[]; };

layout(push_constant) uniform Push {
    uint samples;
    uint dofs;
    uint views;
    float path_kept;
    float path_gain;
    float sigma_gain;
    float sigma_loss;
} push;

shared float squares[SUM_LANES];
shared uint before;

void main() {
    uint lane = gl_LocalInvocationID.x;
    if (lane == 0u) before = outcome.key;
    barrier();
    uint first = evolution.first;
    uint now = order_of(fitness[first]);
    if (now > before) {
        if (lane == 0u) outcome.key = now;
        for (uint d = lane; d < push.dofs; d += SUM_LANES) {
            outcome.values[d] = positions[first * push.dofs + d];
        }
        for (uint view = lane; view < push.views; view += SUM_LANES) {
            best_sums[view] = sums[first * push.views + view];
        }
    }
    // A generation without any finite fitness teaches nothing.
    if (now == 0u) return;
    float sigma = evolution.sigma;
    precise float square = 0.0;
    for (uint d = lane; d < push.dofs; d += SUM_LANES) {
        precise float normal = 0.0;
        precise float step = 0.0;
        for (uint row = 0u; row < push.samples; row++) {
            float weight = weights[row];
            if (weight == 0.0) continue;
            normal = normal + weight * normals[row * push.dofs + d];
            step = step + weight * steps[row * push.dofs + d];
        }
        precise float path = push.path_kept * evolution.values[push.dofs + d] + push.path_gain * normal;
        evolution.values[push.dofs + d] = path;
        precise float mean = evolution.values[d] + sigma * step;
        evolution.values[d] = held_offset(mean, d, push.dofs);
        precise float squared = path * path;
        square = square + squared;
    }
    squares[lane] = square;
    barrier();
    for (uint half_width = SUM_LANES / 2u; half_width > 0u; half_width /= 2u) {
        if (lane < half_width) {
            precise float both = squares[lane] + squares[lane + half_width];
            squares[lane] = both;
        }
        barrier();
    }
    if (lane == 0u) {
        precise float change = push.sigma_gain * root(squares[0]) - push.sigma_loss;
        float capped = change <= 1.0 ? change : 1.0;
        float factor = capped > 0.0 ? reciprocal(exp_of_negative(-capped)) : exp_of_negative(capped);
        precise float next = sigma * factor;
        evolution.sigma = hold(next, uintBitsToFloat(LEAST_SIGMA), uintBitsToFloat(MOST_SIGMA));
    }
}
