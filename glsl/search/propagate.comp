#version 450
#extension GL_GOOGLE_include_directive : require

// A batch of the filter's particles: chosen from the previous ones by their weights, or put on the centre, and moved. One
// invocation a block of random numbers.

#include "search/constants.glsl"
#include "search/frame.glsl"
#include "search/outcome.glsl"

layout(local_size_x = SEARCH_GROUP) in;

layout(std430, set = 0, binding = 2) readonly buffer Previous { float previous[]; };
// Sums of the weights up to and with each previous particle, low and high word.
layout(std430, set = 0, binding = 3) readonly buffer Cumulated { uvec2 cumulated[]; };
layout(std430, set = 0, binding = 4) writeonly buffer Particles { float particles[]; };
layout(std430, set = 0, binding = 5) writeonly buffer Positions { float positions[]; };

layout(push_constant) uniform Push {
    uint first; // particle of the batch
    uint batch;
    uint count; // particles in all
    uint dofs;
} push;

// The first previous particle whose sum is beyond the pointer of `particle`.
uint chosen_for(uint particle) {
    uint fraction = random_words(0u, 0u, DRAW_RESAMPLING, 0u).x;
    uint offset = wide_product(outcome.stride, fraction).y;
    uvec2 pointer = wide_sum(wide_product(particle, outcome.stride), uvec2(offset, 0u));
    uint low = 0u;
    uint high = push.count - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (wide_less(pointer, cumulated[middle])) {
            high = middle;
        } else {
            low = middle + 1u;
        }
    }
    return low;
}

void main() {
    uint row = candidate_here();
    uint block = block_here();
    if (row >= push.batch) return;
    uint particle = push.first + row;
    bool goes_on = frame.goes_on == 1u;
    uint source = goes_on ? chosen_for(particle) : 0u;
    vec4 normals = normals_of(random_words(0u, particle, DRAW_SCATTER, block));
    for (uint word = 0u; word < 4u; word++) {
        uint d = dimension_of(block, word);
        if (d >= push.dofs) break;
        float from = goes_on ? previous[source * push.dofs + d] : frame.values[d];
        float x = scattered(from, normals[word], d, push.dofs);
        particles[particle * push.dofs + d] = x;
        positions[row * push.dofs + d] = x;
    }
}
