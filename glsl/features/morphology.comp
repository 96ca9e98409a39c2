#version 450
#extension GL_GOOGLE_include_directive : require

// Replaces every set pixel by a square or a disc, or every clear one: a word of 32 pixels an invocation.

#include "features/constants.glsl"
#include "features/place.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Before { uint before[]; };
layout(std430, set = 0, binding = 1) writeonly buffer After { uint after[]; };

layout(push_constant) uniform Morphology {
    uint width;
    uint height;
    uint stride;
    int radius;
    uint square; // else a disc
    uint erode;  // the clear pixels are the ones replaced
} push;

uint word(int at, int y) {
    if (at < 0 || at >= int(push.stride)) return 0u;
    uint value = before[uint(y) * push.stride + uint(at)];
    return (push.erode == 0u ? value : ~value) & inside_word(uint(at), push.width);
}

// Whether any of the `count` pixels from each of the 32 from column `x` on is set; at most 33, so that 64 pixels hold them all.
uint any_of(int x, int y, uint count) {
    int at = x >> 5;
    uint shift = uint(x & 31);
    uint first = word(at, y);
    uint second = word(at + 1, y);
    uint third = word(at + 2, y);
    uint low = shift == 0u ? first : (first >> shift) | (second << (32u - shift));
    uint high = shift == 0u ? second : (second >> shift) | (third << (32u - shift));
    for (uint reached = 1u; reached < count;) {
        uint step_ = min(reached, count - reached);
        low |= (low >> step_) | (high << (32u - step_));
        high |= high >> step_;
        reached += step_;
    }
    return low;
}

void main() {
    uint place = flat_place();
    if (place >= push.stride * push.height) return;
    uint at = place % push.stride;
    int y = int(place / push.stride);
    int radius = push.radius;
    uint found = 0u;
    for (int dy = max(-radius, -y); dy <= min(radius, int(push.height) - 1 - y); dy++) {
        int half_width = radius;
        while (push.square == 0u && half_width * half_width > radius * radius - dy * dy) half_width--;
        for (int dx = -half_width; dx <= half_width; dx += 33) {
            found |= any_of(int(at) * 32 + dx, y + dy, uint(min(33, half_width - dx + 1)));
        }
    }
    after[place] = (push.erode == 0u ? found : ~found) & inside_word(at, push.width);
}
