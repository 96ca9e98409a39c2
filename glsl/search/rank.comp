#version 450
#extension GL_GOOGLE_include_directive : require

// The weights of a generation's samples, by how many are better: of equals the lower index is. One invocation a sample.

#include "search/constants.glsl"
#include "search/frame.glsl"
#include "search/evolution.glsl"

layout(local_size_x = SEARCH_GROUP) in;

layout(std430, set = 0, binding = 3) readonly buffer Fitness { float fitness[]; };
layout(std430, set = 0, binding = 5) writeonly buffer Weights { float weights[]; };

layout(push_constant) uniform Push {
    uint samples;
    uint first_weight;
    uint parents;
} push;

#define KEY(sample_index) total_order_of(fitness[sample_index])
#include "search/ranking.glsl"

void main() {
    uint own = gl_GlobalInvocationID.x;
    if (own >= push.samples) return;
    uint rank = rank_of(own, push.samples);
    if (rank == 0u) evolution.first = own;
    weights[own] = weight_of(own, rank);
}
