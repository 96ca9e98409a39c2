#version 450
#extension GL_GOOGLE_include_directive : require

// The start of a swarm: at rest around the frame's centre or the best pose so far, particle 0 on it. One invocation a block of
// random numbers.

#include "search/constants.glsl"
#include "search/frame.glsl"
#include "search/outcome.glsl"

layout(local_size_x = SEARCH_GROUP) in;

layout(std430, set = 0, binding = 2) writeonly buffer Positions { float positions[]; };
layout(std430, set = 0, binding = 3) writeonly buffer Velocities { float velocities[]; };
layout(std430, set = 0, binding = 4) writeonly buffer Best { float best[]; };
// Of the frame's spread, a row a level.
layout(std430, set = 0, binding = 5) readonly buffer Factors { float factors[]; };

layout(push_constant) uniform Push {
    uint particles;
    uint dofs;
    uint level;
    uint iteration;
} push;

void main() {
    uint particle = candidate_here();
    uint block = block_here();
    if (particle >= push.particles) return;
    vec4 normals = normals_of(random_words(push.iteration, particle, DRAW_SCATTER, block));
    for (uint word = 0u; word < 4u; word++) {
        uint d = dimension_of(block, word);
        if (d >= push.dofs) break;
        float from = push.level == 0u ? frame.values[d] : outcome.values[d];
        float factor = factors[push.level * push.dofs + d];
        float x = scattered(from, particle == 0u ? 0.0 : normals[word], factor, d, push.dofs);
        uint place = particle * push.dofs + d;
        positions[place] = x;
        velocities[place] = 0.0;
        best[place] = x;
    }
}
