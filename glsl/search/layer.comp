#version 450
#extension GL_GOOGLE_include_directive : require

// A layer of the annealed filter's particles: around the centre, one of them on it, or chosen from the layer before by their
// weights and moved. One invocation a block of random numbers.

#include "search/constants.glsl"
#include "search/resample.glsl"

layout(local_size_x = SEARCH_GROUP) in;

layout(std430, set = 0, binding = 4) writeonly buffer Positions { float positions[]; };

layout(push_constant) uniform Push {
    uint particles;
    uint dofs;
    uint layer;
    float noise; // factor on the frame's spread
} push;

void main() {
    uint particle = candidate_here();
    uint block = block_here();
    if (particle >= push.particles) return;
    bool is_first = push.layer == 0u;
    // A layer without any finite fitness has nothing to choose by.
    bool chooses = !is_first && outcome.key != 0u;
    uint source = chooses ? chosen_for(particle, push.layer, push.particles) : particle;
    uint address = is_first ? particle - 1u : particle;
    vec4 normals = normals_of(random_words(push.layer, address, DRAW_SCATTER, block));
    for (uint word = 0u; word < 4u; word++) {
        uint d = dimension_of(block, word);
        if (d >= push.dofs) break;
        float from = is_first ? frame.values[d] : previous[source * push.dofs + d];
        float normal = is_first && particle == 0u ? 0.0 : normals[word];
        positions[particle * push.dofs + d] = scattered(from, normal, push.noise, d, push.dofs);
    }
}
