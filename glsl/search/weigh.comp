#version 450
#extension GL_GOOGLE_include_directive : require

// The filter's weights as shares of the largest, and their running sums. One workgroup. Sums are integers of 64 bits, so they
// are exact however the work is divided.

#include "search/constants.glsl"
#include "search/arithmetic.glsl"

layout(local_size_x = LOOK_GROUP) in;

layout(std430, set = 0, binding = 0) readonly buffer Fitness { float fitness[]; };
#include "search/outcome.glsl"
layout(std430, set = 0, binding = 2) readonly buffer Particles { float particles[]; };
layout(std430, set = 0, binding = 3) writeonly buffer Weights { float weights[]; };
layout(std430, set = 0, binding = 4) buffer Cumulated { uvec2 cumulated[]; };

layout(push_constant) uniform Push {
    uint count;
    uint dofs;
    float sharpness; // 1 / (2 sigma^2)
} push;

const uint NONE = 0xFFFFFFFFu;

shared uint distances[LOOK_GROUP];
shared uint places[LOOK_GROUP];
shared uvec2 sums[LOOK_GROUP];

void main() {
    uint lane = gl_LocalInvocationID.x;
    // The particle nearest to a fitness of 1. Distances of 0 or more are ordered as their bits are.
    uint least = NONE;
    uint place = 0u;
    for (uint particle = lane; particle < push.count; particle += LOOK_GROUP) {
        float f = fitness[particle];
        precise float off = 1.0 - f;
        uint bits = floatBitsToUint(off) & 0x7FFFFFFFu;
        if (is_finite(f) && bits < least) {
            least = bits;
            place = particle;
        }
    }
    distances[lane] = least;
    places[lane] = place;
    barrier();
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

    uint stretch = (push.count + LOOK_GROUP - 1u) / LOOK_GROUP;
    uint first = min(lane * stretch, push.count);
    uint end = min(first + stretch, push.count);
    uvec2 sum = uvec2(0u);
    for (uint particle = first; particle < end; particle++) {
        float f = fitness[particle];
        float share = 0.0;
        if (is_finite(f)) {
            precise float exponent = (f - largest) * (2.0 - f - largest) * push.sharpness;
            share = exp_of_negative(exponent > 0.0 ? 0.0 : exponent);
        }
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
