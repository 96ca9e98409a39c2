#version 450
#extension GL_GOOGLE_include_directive : require

// What a ready mask says of every pixel, in the place of the log density of its colour as background; and which colour it is.

#include "features/constants.glsl"
#include "features/picture.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Colours { uint colours[]; };
layout(std430, set = 0, binding = 1) readonly buffer Mask { uint mask[]; };
// The density in the lower half, steps; the colour in the upper.
layout(std430, set = 0, binding = 2) writeonly buffer Seen { uint seen[]; };

uint step_of(uint at) {
    return (colours[at >> 2u] >> (8u * (at & 3u) + 4u)) & 15u;
}

void main() {
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= picture.width) return;
    uint pixel = at.y * picture.width + at.x;
    bool inside = ((mask[at.y * picture.stride + (at.x >> 5u)] >> (at.x & 31u)) & 1u) != 0u;
    int density = inside ? -int(LIKELIHOOD_MASKED) : int(LIKELIHOOD_SURE);
    uint bin = (step_of(3u * pixel) << 8u) | (step_of(3u * pixel + 1u) << 4u) | step_of(3u * pixel + 2u);
    seen[pixel] = (uint(density) & 0xffffu) | (bin << 16u);
}
