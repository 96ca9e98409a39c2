#version 450
#extension GL_GOOGLE_include_directive : require

// The weights of a generation's samples, by how many are better: of equals the lower index is. One invocation a sample.

#include "search/constants.glsl"
#include "search/frame.glsl"
#include "search/evolution.glsl"

layout(local_size_x = SEARCH_GROUP) in;

layout(std430, set = 0, binding = 3) readonly buffer Fitness { float fitness[]; };
// Of the better half, best first.
layout(std430, set = 0, binding = 4) readonly buffer Ranked { float ranked[]; };
layout(std430, set = 0, binding = 5) writeonly buffer Weights { float weights[]; };

layout(push_constant) uniform Push {
    uint samples;
    uint first_weight;
    uint parents;
} push;

void main() {
    uint own = gl_GlobalInvocationID.x;
    if (own >= push.samples) return;
    uint key = total_order_of(fitness[own]);
    uint rank = 0u;
    for (uint other = 0u; other < push.samples; other++) {
        uint found = total_order_of(fitness[other]);
        if (found > key || (found == key && other < own)) rank++;
    }
    if (rank == 0u) evolution.first = own;
    weights[own] = key != 0u && rank < push.parents ? ranked[push.first_weight + rank] : 0.0;
}
