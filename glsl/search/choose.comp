#version 450
#extension GL_GOOGLE_include_directive : require

// The estimate of an evolution: the mean of the last distribution, unless the best sample is better. One workgroup.

#include "search/constants.glsl"
#include "search/arithmetic.glsl"

layout(local_size_x = SUM_LANES) in;

layout(std430, set = 0, binding = 0) readonly buffer Fitness { float fitness[]; };
#include "search/outcome.glsl"
layout(std430, set = 0, binding = 2) readonly buffer Sums { uvec4 sums[]; };
layout(std430, set = 0, binding = 3) writeonly buffer BestSums { uvec4 best_sums[]; };

layout(push_constant) uniform Push {
    uint dofs;
    uint views;
} push;

shared uint before;

void main() {
    uint lane = gl_LocalInvocationID.x;
    if (lane == 0u) before = outcome.key;
    barrier();
    uint now = order_of(fitness[0]);
    // Without any finite fitness there is nothing to choose from, and the host says so.
    if (before == 0u || now < before) return;
    if (lane == 0u) outcome.key = now;
    for (uint d = lane; d < push.dofs; d += SUM_LANES) {
        outcome.values[d] = outcome.values[2u * push.dofs + d];
    }
    for (uint view = lane; view < push.views; view += SUM_LANES) {
        best_sums[view] = sums[view];
    }
}
