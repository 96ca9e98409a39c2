#version 450
#extension GL_GOOGLE_include_directive : require

// The log density of every pixel's colour as background, and which colour it is; a second time only round what was found, in the light
// that is there.

#include "features/likely.glsl"

layout(local_size_x = 64) in;

// Pixels in shadow, and all that look like background.
layout(std430, set = 0, binding = 6) readonly buffer Counted { uint counted[]; };
// The density in the lower half, steps; the colour in the upper.
layout(std430, set = 0, binding = 7) writeonly buffer Seen { uint seen[]; };

shared uint own_step;

void main() {
    if (gl_LocalInvocationID.x == 0u) {
        precise float in_shadow = light.assumed[0] + float(counted[0]);
        precise float all = light.assumed[1] + float(counted[1]);
        float share = clamp(quotient(in_shadow, all), light.believed[0], light.believed[1]);
        uint reached = 0u;
        for (uint i = 0u; i + 1u < SHADOW_STEPS; i++) reached += uint(share >= light.from[i]);
        own_step = reached;
    }
    barrier();
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= push.width) return;
    if (push.again != 0u) {
        uvec4 near = region();
        if (any(lessThan(at, near.xy)) || any(greaterThanEqual(at, near.zw))) return;
    }
    uint pixel = at.y * push.width + at.x;
    uvec3 colour = colour_of(pixel);
    vec2 found = hypotheses(colour, pixel, light.judging[own_step * LIKELY_SLOPES + slope_of(pixel)]);
    precise float density = max(max(found.x, found.y), light.outlier) * float(LIKELIHOOD_STEPS);
    uvec3 bin = colour >> 4u;
    seen[pixel] = (uint(int(density)) & 0xffffu) | (bin.x << 24u) | (bin.y << 20u) | (bin.z << 16u);
}
