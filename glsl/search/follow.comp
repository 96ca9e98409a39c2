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

#include "search/learning.glsl"

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
        vec2 learnt = weighed(d, push.samples);
        float path = path_after(d, learnt.x);
        evolution.values[push.dofs + d] = path;
        evolution.values[d] = mean_after(d, learnt.y, sigma);
        precise float squared = path * path;
        square = square + squared;
    }
    float all = sum_of_squares(square);
    if (lane == 0u) evolution.sigma = sigma_after(sigma, all);
}
