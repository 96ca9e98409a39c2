#version 450
#extension GL_GOOGLE_include_directive : require

// The median of the counted ratios: an invocation a channel.

#include "features/constants.glsl"

layout(local_size_x = 3) in;

layout(std430, set = 0, binding = 0) readonly buffer Counts { uint counts[]; };
// How many 128ths of the background's brightness the picture has, channel by channel.
layout(std430, set = 0, binding = 1) writeonly buffer Gains { uint gains[]; };

void main() {
    uint channel = gl_LocalInvocationID.x;
    uint total = 0u;
    for (uint i = 0u; i < RATIO_COUNTS; i++) total += counts[channel * RATIO_COUNTS + i];
    uint below = 0u;
    uint median = RATIO_STEPS;
    for (uint i = 0u; i < RATIO_COUNTS; i++) {
        below += counts[channel * RATIO_COUNTS + i];
        if (below > total / 2u) {
            median = i;
            break;
        }
    }
    gains[channel] = clamp(median, RATIO_LEAST, RATIO_MOST);
}
