#version 450
#extension GL_GOOGLE_include_directive : require

// From colour to grey, smoothed by a 3x3 Gauss (METHOD A5.2). What lies outside the picture repeats its border.

#include "features/constants.glsl"
#include "features/picture.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Colours { uint colours[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Smoothed { uint smoothed[]; };

// 0: grey as it is.
layout(constant_id = 0) const uint SMOOTH = 1u;

uint byte_at(uint at) {
    return (colours[at >> 2u] >> (8u * (at & 3u))) & 255u;
}

uint gray(int x, int y) {
    uint column = uint(clamp(x, 0, int(picture.width) - 1));
    uint row = uint(clamp(y, 0, int(picture.height) - 1));
    uint at = 3u * (row * picture.width + column);
    return (77u * byte_at(at) + 151u * byte_at(at + 1u) + 28u * byte_at(at + 2u)) >> 8u;
}

uint across(int x, int y) {
    return gray(x - 1, y) + 2u * gray(x, y) + gray(x + 1, y);
}

void main() {
    int x = int(gl_GlobalInvocationID.x);
    int y = int(gl_GlobalInvocationID.y);
    if (x >= int(picture.width)) return;
    uint smooths = SMOOTH;
    uint value = 0u;
    if (smooths == 1u) {
        value = (across(x, y - 1) + 2u * across(x, y) + across(x, y + 1) + 8u) >> 4u;
    } else {
        value = gray(x, y);
    }
    smoothed[uint(y) * picture.width + uint(x)] = value;
}
