#version 450
#extension GL_GOOGLE_include_directive : require

// The start of a swarm: at rest around the centre, particle 0 on it. One invocation a block of random numbers.

#include "search/constants.glsl"
#include "search/frame.glsl"

layout(local_size_x = SEARCH_GROUP) in;

layout(std430, set = 0, binding = 1) writeonly buffer Positions { float positions[]; };
layout(std430, set = 0, binding = 2) writeonly buffer Velocities { float velocities[]; };
layout(std430, set = 0, binding = 3) writeonly buffer Best { float best[]; };

layout(push_constant) uniform Push {
    uint particles;
    uint dofs;
} push;

void main() {
    uint particle = candidate_here();
    uint block = block_here();
    if (particle >= push.particles) return;
    vec4 normals = normals_of(random_words(0u, particle, DRAW_SCATTER, block));
    for (uint word = 0u; word < 4u; word++) {
        uint d = dimension_of(block, word);
        if (d >= push.dofs) break;
        float x = scattered(frame.values[d], particle == 0u ? 0.0 : normals[word], d, push.dofs);
        uint place = particle * push.dofs + d;
        positions[place] = x;
        velocities[place] = 0.0;
        best[place] = x;
    }
}
