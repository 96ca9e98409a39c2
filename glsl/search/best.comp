#version 450
#extension GL_GOOGLE_include_directive : require

// After an iteration's fitness is known: which particles improved, and the swarm's best. One workgroup. Fitness is compared as
// integers of the same order: what is not finite is 0, less than anything, and no device's treatment of infinities matters.

#include "search/constants.glsl"
#include "search/arithmetic.glsl"

layout(local_size_x = LOOK_GROUP) in;

layout(std430, set = 0, binding = 0) readonly buffer Fitness { float fitness[]; };
#include "search/outcome.glsl"
layout(std430, set = 0, binding = 2) readonly buffer Positions { float positions[]; };
// Of a particle: the order of its best fitness so far, and 1 where this iteration's is it.
layout(std430, set = 0, binding = 3) buffer Own { uvec2 own[]; };
// The order of the swarm's best fitness after each iteration.
layout(std430, set = 0, binding = 4) writeonly buffer History { uint history[]; };

// What stands behind the fitness of every particle, and of the best one, a row of views each.
layout(std430, set = 0, binding = 5) readonly buffer Sums { uvec4 sums[]; };
layout(std430, set = 0, binding = 6) writeonly buffer BestSums { uvec4 best_sums[]; };

layout(push_constant) uniform Push {
    uint particles;
    uint dofs;
    uint views;
    uint iteration;
    uint is_first; // 1 where all that was found before is forgotten
} push;

shared uint keys[LOOK_GROUP];
shared uint places[LOOK_GROUP];
shared uint leads;

void main() {
    uint lane = gl_LocalInvocationID.x;
    uint key = 0u;
    uint place = 0u;
    for (uint particle = lane; particle < push.particles; particle += LOOK_GROUP) {
        uint now = order_of(fitness[particle]);
        uint before = push.is_first == 1u ? 0u : own[particle].x;
        own[particle] = uvec2(max(now, before), now > before ? 1u : 0u);
        // Of equals the lower index stays.
        if (now > key) {
            key = now;
            place = particle;
        }
    }
    keys[lane] = key;
    places[lane] = place;
    barrier();
    for (uint half_width = LOOK_GROUP / 2u; half_width > 0u; half_width /= 2u) {
        if (lane < half_width) {
            uint other = lane + half_width;
            if (keys[other] > keys[lane] || (keys[other] == keys[lane] && places[other] < places[lane])) {
                keys[lane] = keys[other];
                places[lane] = places[other];
            }
        }
        barrier();
    }
    if (lane == 0u) {
        uint before = push.is_first == 1u ? 0u : outcome.key;
        // A swarm without any fitness gathers where the first particle is.
        leads = keys[0] > before || push.is_first == 1u ? 1u : 0u;
        uint after = max(before, keys[0]);
        outcome.key = after;
        history[push.iteration] = after;
        if (keys[0] == 0u) places[0] = 0u;
    }
    barrier();
    if (leads == 1u) {
        for (uint d = lane; d < push.dofs; d += LOOK_GROUP) {
            outcome.values[d] = positions[places[0] * push.dofs + d];
        }
        for (uint view = lane; view < push.views; view += LOOK_GROUP) {
            best_sums[view] = sums[places[0] * push.views + view];
        }
    }
}
