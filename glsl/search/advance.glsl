// An iteration of a swarm behind its drawing, in one stage: fitness, who improved, the best of all, and the move. Each workgroup looks
// over all particles and moves a share of them, so that none waits for another, which Vulkan lets none. What all read nobody may write
// meanwhile: positions and the best pose of all are there twice, and an iteration reads one side and writes the other.

#define SEARCH_SET 1
#include "search/constants.glsl"
#include "search/frame.glsl"
#include "search/outcome.glsl"
#include "evaluate/scoring.glsl"

layout(local_size_x = LOOK_GROUP) in;

// Where the evaluator takes them from.
layout(std430, set = 1, binding = 2) writeonly buffer Poses { float poses[]; };
// [side][particle][degree of freedom]
layout(std430, set = 1, binding = 3) buffer Positions { float positions[]; };
layout(std430, set = 1, binding = 4) buffer Velocities { float velocities[]; };
layout(std430, set = 1, binding = 5) buffer Best { float best[]; };
// Of a particle: the order of its best fitness so far, and 1 where this iteration's is it. Invocations of the workgroup that has the
// particle tell each other.
layout(std430, set = 1, binding = 6) coherent buffer Own { uvec2 own[]; };
// The order of the swarm's best fitness after each iteration.
layout(std430, set = 1, binding = 7) writeonly buffer History { uint history[]; };
// What stands behind the fitness of the best particle, a row of views.
layout(std430, set = 1, binding = 8) writeonly buffer BestSums { uvec4 best_sums[]; };
// The order of the swarm's best fitness and, as bits, its pose: [side][1 + degrees of freedom].
layout(std430, set = 1, binding = 9) buffer Lead { uint lead[]; };

layout(push_constant) uniform Advance {
    Scoring scoring;
    uint dofs;
    uint done;      // iterations of the frame
    uint is_first;  // 1 where all that was found before is forgotten
    uint side;      // that is read
    uint iteration; // the one moved into; 0 to take note only
    float inertia;
    float cognitive;
    float social;
} push;

#include "search/scored.glsl"
#include "search/step.glsl"

shared uint keys[LOOK_GROUP];
shared uint places[LOOK_GROUP];

void main() {
    uint lane = gl_LocalInvocationID.x;
    uint particles = push.scoring.candidates;
    uint share = (particles + gl_NumWorkGroups.x - 1u) / gl_NumWorkGroups.x;
    uint begin = min(gl_WorkGroupID.x * share, particles);
    uint end = min(begin + share, particles);
    uint key = 0u;
    uint place = 0u;
    for (uint particle = lane; particle < particles; particle += LOOK_GROUP) {
        uint now = order_of(fitness_of(particle));
        if (particle >= begin && particle < end) {
            uint before = push.is_first == 1u ? 0u : own[particle].x;
            own[particle] = uvec2(max(now, before), now > before ? 1u : 0u);
        }
        // Of equals the lower index stays.
        if (now > key) {
            key = now;
            place = particle;
        }
    }
    keys[lane] = key;
    places[lane] = place;
    memoryBarrierBuffer();
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
    uint from = push.side * particles * push.dofs;
    uint to = (1u - push.side) * particles * push.dofs;
    uint lead_from = push.side * (push.dofs + 1u);
    uint lead_to = (1u - push.side) * (push.dofs + 1u);
    uint before = push.is_first == 1u ? 0u : lead[lead_from];
    // A swarm without any fitness gathers where the first particle is.
    bool leads = keys[0] > before || push.is_first == 1u;
    uint leader = keys[0] == 0u ? 0u : places[0];
    if (gl_WorkGroupID.x == 0u) {
        if (lane == 0u) {
            uint after = max(before, keys[0]);
            outcome.key = after;
            history[push.done] = after;
            lead[lead_to] = after;
        }
        for (uint d = lane; d < push.dofs; d += LOOK_GROUP) {
            uint bits = leads ? floatBitsToUint(positions[from + leader * push.dofs + d]) : lead[lead_from + 1u + d];
            outcome.values[d] = uintBitsToFloat(bits);
            lead[lead_to + 1u + d] = bits;
        }
        if (leads) {
            for (uint view = lane; view < push.scoring.views; view += LOOK_GROUP) {
                best_sums[view] = sums_at(leader * push.scoring.views + view);
            }
        }
    }
    uint blocks = 8u * ((push.dofs + 31u) / 32u);
    for (uint task = lane; task < (end - begin) * blocks; task += LOOK_GROUP) {
        uint particle = begin + task / blocks;
        uint block = task % blocks;
        bool improved = own[particle].y == 1u;
        vec4 r1 = uniforms_of(random_words(push.iteration, particle, DRAW_COGNITIVE, block));
        vec4 r2 = uniforms_of(random_words(push.iteration, particle, DRAW_SOCIAL, block));
        for (uint word = 0u; word < 4u; word++) {
            uint d = dimension_of(block, word);
            if (d >= push.dofs) break;
            uint at = particle * push.dofs + d;
            float x = positions[from + at];
            float p = best[at];
            if (improved) {
                p = x;
                best[at] = x;
            }
            if (push.iteration == 0u) continue;
            float g = leads ? positions[from + leader * push.dofs + d] : uintBitsToFloat(lead[lead_from + 1u + d]);
            Step next = step_from(x, velocities[at], vec2(p, g), vec2(r1[word], r2[word]), limits_of(d, push.dofs));
            velocities[at] = next.velocity;
            positions[to + at] = next.position;
            poses[at] = next.position;
        }
    }
}
