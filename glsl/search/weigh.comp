#version 450
#extension GL_GOOGLE_include_directive : require

// A filter's weights as shares of the largest, and their running sums, after the sharpness that an annealed one takes. One
// workgroup. Running sums are integers of 64 bits, so they are exact however the work is divided.

#include "search/constants.glsl"
#include "search/arithmetic.glsl"

layout(local_size_x = LOOK_GROUP) in;

layout(std430, set = 0, binding = 0) readonly buffer Fitness { float fitness[]; };
#include "search/outcome.glsl"
layout(std430, set = 0, binding = 2) readonly buffer Particles { float particles[]; };
layout(std430, set = 0, binding = 3) writeonly buffer Weights { float weights[]; };
layout(std430, set = 0, binding = 4) buffer Cumulated { uvec2 cumulated[]; };
// Of the layer before where it anneals.
layout(std430, set = 0, binding = 5) buffer Sharpness { float sharpness; };

layout(push_constant) uniform Push {
    uint count;
    uint dofs;
    float survival; // share of the particles to leave; 0 where the sharpness is a constant
} push;

const uint NONE = 0xFFFFFFFFu;

shared uint distances[LOOK_GROUP];
shared uint places[LOOK_GROUP];
shared uvec2 sums[LOOK_GROUP];
shared uint finite;
// Sums of shares and of their squares, `ANNEAL_LANES` of each for every sharpness that is tried.
shared vec2 tried[LOOK_GROUP];

// What is left of the bit patterns from `between.x` to `between.y` after as many halvings as `path` has bits after its first one,
// each of which says whether the upper half was taken.
uvec2 halved(uvec2 between, uint path) {
    for (int level = findMSB(path) - 1; level >= 0; level--) {
        uint middle = between.x + (between.y - between.x) / 2u;
        if ((path >> level & 1u) == 1u) {
            between.x = middle;
        } else {
            between.y = middle;
        }
    }
    return between;
}

float share_of(float f, float largest, float sharp) {
    if (!is_finite(f)) return 0.0;
    precise float exponent = (f - largest) * (2.0 - f - largest) * sharp;
    return exp_of_negative(exponent > 0.0 ? 0.0 : exponent);
}

// The sharpness that leaves the wanted share, found by halving as src/search/weights.rs does it. A round tries all that
// `HALVINGS_AT_ONCE` halvings may come to, the root of their tree first, and then goes down the tree.
float annealed(float largest) {
    uint lane = gl_LocalInvocationID.x;
    uint path = lane / ANNEAL_LANES + 1u;
    precise float wanted = push.survival * float(finite);
    uvec2 between = uvec2(LEAST_SHARPNESS, MOST_SHARPNESS);
    for (uint round = 0u; round < HALVINGS / HALVINGS_AT_ONCE; round++) {
        uvec2 own = halved(between, path);
        float sharp = uintBitsToFloat(own.x + (own.y - own.x) / 2u);
        precise float sum = 0.0;
        precise float squares = 0.0;
        for (uint particle = lane % ANNEAL_LANES; particle < push.count; particle += ANNEAL_LANES) {
            float share = share_of(fitness[particle], largest, sharp);
            precise float square = share * share;
            sum = sum + share;
            squares = squares + square;
        }
        tried[lane] = vec2(sum, squares);
        barrier();
        for (uint half_width = ANNEAL_LANES / 2u; half_width > 0u; half_width /= 2u) {
            if (lane % ANNEAL_LANES < half_width) {
                precise vec2 both = tried[lane] + tried[lane + half_width];
                tried[lane] = both;
            }
            barrier();
        }
        uint taken = 1u;
        for (uint level = 0u; level < HALVINGS_AT_ONCE; level++) {
            vec2 found = tried[(taken - 1u) * ANNEAL_LANES];
            precise float left = found.x * found.x;
            precise float least = wanted * found.y;
            taken = taken * 2u + (left > least ? 1u : 0u);
        }
        between = halved(between, taken);
        barrier();
    }
    return uintBitsToFloat(between.x);
}

void main() {
    uint lane = gl_LocalInvocationID.x;
    // The particle nearest to a fitness of 1. Distances of 0 or more are ordered as their bits are.
    uint least = NONE;
    uint place = 0u;
    uint count = 0u;
    if (lane == 0u) finite = 0u;
    for (uint particle = lane; particle < push.count; particle += LOOK_GROUP) {
        float f = fitness[particle];
        precise float off = 1.0 - f;
        uint bits = floatBitsToUint(off) & 0x7FFFFFFFu;
        if (!is_finite(f)) continue;
        count++;
        if (bits < least) {
            least = bits;
            place = particle;
        }
    }
    distances[lane] = least;
    places[lane] = place;
    barrier();
    atomicAdd(finite, count);
    for (uint half_width = LOOK_GROUP / 2u; half_width > 0u; half_width /= 2u) {
        if (lane < half_width) {
            uint other = lane + half_width;
            if (distances[other] < distances[lane]
                || (distances[other] == distances[lane] && places[other] < places[lane])) {
                distances[lane] = distances[other];
                places[lane] = places[other];
            }
        }
        barrier();
    }
    uint nearest = places[0];
    bool any = distances[0] != NONE;
    float largest = any ? fitness[nearest] : 0.0;
    float sharp = sharpness;
    if (push.survival > 0.0 && any) {
        sharp = max(annealed(largest), sharp);
        if (lane == 0u) sharpness = sharp;
    }

    uint stretch = (push.count + LOOK_GROUP - 1u) / LOOK_GROUP;
    uint first = min(lane * stretch, push.count);
    uint end = min(first + stretch, push.count);
    uvec2 sum = uvec2(0u);
    for (uint particle = first; particle < end; particle++) {
        float share = share_of(fitness[particle], largest, sharp);
        weights[particle] = share;
        sum = wide_sum(sum, uvec2(uint(share * 2147483648.0), 0u));
        cumulated[particle] = sum;
    }
    sums[lane] = sum;
    barrier();
    for (uint reach = 1u; reach < LOOK_GROUP; reach *= 2u) {
        uvec2 before = lane >= reach ? sums[lane - reach] : uvec2(0u);
        barrier();
        sums[lane] = wide_sum(sums[lane], before);
        barrier();
    }
    if (lane > 0u) {
        uvec2 before = sums[lane - 1u];
        for (uint particle = first; particle < end; particle++) {
            cumulated[particle] = wide_sum(cumulated[particle], before);
        }
    }
    if (lane == 0u) {
        uvec2 total = sums[LOOK_GROUP - 1u];
        // total / count by hand; a mean weight fits a word.
        uint quotient = 0u;
        for (int bit = 31; bit >= 0; bit--) {
            uvec2 next = wide_product(quotient | 1u << bit, push.count);
            if (!wide_less(total, next)) quotient |= 1u << bit;
        }
        outcome.stride = quotient;
        outcome.key = any ? 1u : 0u;
    }
    for (uint d = lane; d < push.dofs; d += LOOK_GROUP) {
        outcome.values[d] = particles[nearest * push.dofs + d];
    }
}
