#version 450
#extension GL_GOOGLE_include_directive : require

// A fitness to test searches with: a bowl around a target with ripples in it, of operations that the host repeats to the bit.

#include "search/constants.glsl"

layout(local_size_x = SEARCH_GROUP) in;

layout(std430, set = 0, binding = 0) readonly buffer Target { float target[]; };
layout(std430, set = 0, binding = 1) readonly buffer Positions { float positions[]; };
layout(std430, set = 0, binding = 2) writeonly buffer Fitness { float fitness[]; };
layout(std430, set = 0, binding = 3) writeonly buffer Sums { uvec4 sums[]; };

layout(push_constant) uniform Push {
    uint candidates;
    uint dofs;
    uint bad_from; // bits of a number: candidates whose first value is larger have `bad` for a fitness
    uint bad;
    uint nudged; // a candidate whose fitness is another one, of which the host knows nothing
} push;

void main() {
    uint own = gl_GlobalInvocationID.x;
    if (own >= push.candidates) return;
    precise float bowl = 0.0;
    precise float ripples = 0.0;
    for (uint d = 0u; d < push.dofs; d++) {
        float x = positions[own * push.dofs + d];
        precise float off = x - target[d];
        precise float squared = off * off;
        bowl = bowl + squared;
        precise float ripple = abs(off - floor(off) - 0.5);
        ripples = ripples + ripple;
    }
    precise float score = 0.9 - bowl * 0.0078125 - (0.5 * float(push.dofs) - ripples) * 0.00390625;
    bool is_bad = positions[own * push.dofs] > uintBitsToFloat(push.bad_from);
    uint bits = is_bad ? push.bad : floatBitsToUint(own == push.nudged ? 0.95 : score);
    fitness[own] = uintBitsToFloat(bits);
    sums[2u * own] = uvec4(bits, own, 2u, 3u);
    sums[2u * own + 1u] = uvec4(own, bits, 5u, 6u);
}
