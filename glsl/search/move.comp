#version 450
#extension GL_GOOGLE_include_directive : require

// Every particle takes note of its best and moves. One invocation a block of random numbers.

#include "search/constants.glsl"
#include "search/frame.glsl"
#include "search/outcome.glsl"

layout(local_size_x = SEARCH_GROUP) in;

layout(std430, set = 0, binding = 2) buffer Positions { float positions[]; };
layout(std430, set = 0, binding = 3) buffer Velocities { float velocities[]; };
layout(std430, set = 0, binding = 4) buffer Best { float best[]; };
layout(std430, set = 0, binding = 5) readonly buffer Own { uvec2 own[]; };

layout(push_constant) uniform Push {
    uint particles;
    uint dofs;
    uint iteration; // the one moved into; 0 to take note only
    float inertia;
    float cognitive;
    float social;
} push;

#include "search/step.glsl"

void main() {
    uint particle = candidate_here();
    uint block = block_here();
    if (particle >= push.particles) return;
    bool improved = own[particle].y == 1u;
    vec4 r1 = uniforms_of(random_words(push.iteration, particle, DRAW_COGNITIVE, block));
    vec4 r2 = uniforms_of(random_words(push.iteration, particle, DRAW_SOCIAL, block));
    for (uint word = 0u; word < 4u; word++) {
        uint d = dimension_of(block, word);
        if (d >= push.dofs) break;
        uint place = particle * push.dofs + d;
        float x = positions[place];
        float p = best[place];
        if (improved) {
            p = x;
            best[place] = x;
        }
        if (push.iteration == 0u) continue;
        Step next = step_from(x, velocities[place], vec2(p, outcome.values[d]), vec2(r1[word], r2[word]), limits_of(d, push.dofs));
        velocities[place] = next.velocity;
        positions[place] = next.position;
    }
}
