#version 450
#extension GL_GOOGLE_include_directive : require

// Replaces every set pixel by a square or a disc: a word of 32 pixels an invocation.

#include "features/constants.glsl"
#include "features/picture.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Before { uint before[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Dilated { uint dilated[]; };

uint word(int at, int y) {
    bool inside = at >= 0 && at < int(picture.stride) && y >= 0 && y < int(picture.height);
    return inside ? before[uint(y) * picture.stride + uint(at)] : 0u;
}

// The 32 pixels of a row from column `x` on.
uint pixels(int x, int y) {
    int at = x >> 5;
    uint shift = uint(x & 31);
    uint low = word(at, y) >> shift;
    return shift == 0u ? low : low | (word(at + 1, y) << (32u - shift));
}

void main() {
    uint at = gl_GlobalInvocationID.x;
    int y = int(gl_GlobalInvocationID.y);
    if (at >= picture.stride) return;
    int radius = picture.amount;
    uint found = 0u;
    for (int dy = -radius; dy <= radius; dy++) {
        int half_width = radius;
        while (picture.square == 0u && half_width * half_width > radius * radius - dy * dy) half_width--;
        for (int dx = -half_width; dx <= half_width; dx++) {
            found |= pixels(int(at) * 32 + dx, y + dy);
        }
    }
    // Bits past the width stay zero.
    int left = int(picture.width) - int(at) * 32;
    uint mask = left >= 32 ? 0xffffffffu : (left <= 0 ? 0u : (1u << uint(left)) - 1u);
    dilated[uint(y) * picture.stride + at] = found & mask;
}
