#version 450
#extension GL_GOOGLE_include_directive : require

// A batch of the filter's particles: chosen from the previous ones by their weights, or put on the centre, and moved. One
// invocation a block of random numbers.

#include "search/constants.glsl"
#include "search/resample.glsl"

layout(local_size_x = SEARCH_GROUP) in;

layout(std430, set = 0, binding = 4) writeonly buffer Particles { float particles[]; };
layout(std430, set = 0, binding = 5) writeonly buffer Positions { float positions[]; };

layout(push_constant) uniform Push {
    uint first; // particle of the batch
    uint batch;
    uint count; // particles in all
    uint dofs;
} push;

void main() {
    uint row = candidate_here();
    uint block = block_here();
    if (row >= push.batch) return;
    uint particle = push.first + row;
    bool goes_on = frame.goes_on == 1u;
    uint source = goes_on ? chosen_for(particle, 0u, push.count) : 0u;
    vec4 normals = normals_of(random_words(0u, particle, DRAW_SCATTER, block));
    for (uint word = 0u; word < 4u; word++) {
        uint d = dimension_of(block, word);
        if (d >= push.dofs) break;
        float from = goes_on ? previous[source * push.dofs + d] : frame.values[d];
        float x = scattered(from, normals[word], 1.0, d, push.dofs);
        particles[particle * push.dofs + d] = x;
        positions[row * push.dofs + d] = x;
    }
}
