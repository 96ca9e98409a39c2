#version 450
#extension GL_GOOGLE_include_directive : require

// Canny's thinning among the pixels near the silhouette: a gradient is an edge only where it is the largest across the edge
// (src/features/edges/canny.rs). The hysteresis between the two pictures is left to their components.

#include "features/gradient.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 1) readonly buffer Near { uint near[]; };
layout(std430, set = 0, binding = 2) writeonly buffer Weak { uint weak[]; };
layout(std430, set = 0, binding = 3) writeonly buffer Strong { uint strong[]; };

layout(constant_id = 0) const uint MAGNITUDE = 0u;

shared uint words[4];

int order_at(int x, int y, uint magnitude) {
    if (x < 0 || y < 0 || x >= int(picture.width) || y >= int(picture.height)) return 0;
    return order(separable(x, y, 1, 2), magnitude);
}

// The direction of the gradient is one of four, in steps of 45 degrees; (|gx| + |gy|)^2 < 2 gx^2 decides exactly.
ivec2 across(ivec2 g) {
    int wide = abs(g.x);
    int tall = abs(g.y);
    int both = (wide + tall) * (wide + tall);
    if (both < 2 * wide * wide) return ivec2(1, 0);
    if (both < 2 * tall * tall) return ivec2(0, 1);
    return (g.x < 0) == (g.y < 0) ? ivec2(1, 1) : ivec2(-1, 1);
}

void main() {
    uint lane = gl_LocalInvocationID.x;
    int x = int(gl_GlobalInvocationID.x);
    int y = int(gl_GlobalInvocationID.y);
    uint magnitude = MAGNITUDE;
    uint place = uint(y) * picture.stride + (uint(x) >> 5u);
    if (lane < 4u) words[lane] = 0u;
    barrier();
    // The stride is a whole number of workgroups, so the word is there even where the pixel is not.
    bool wanted = x < int(picture.width) && ((near[place] >> (uint(x) & 31u)) & 1u) != 0u;
    if (wanted) {
        ivec2 g = separable(x, y, 1, 2);
        int here = order(g, magnitude);
        if (here >= order_of(picture.low, magnitude)) {
            ivec2 d = across(g);
            // Of equals the first in reading order stays.
            bool largest = here > order_at(x - d.x, y - d.y, magnitude) && here >= order_at(x + d.x, y + d.y, magnitude);
            uint bit = 1u << (lane & 31u);
            if (largest) atomicOr(words[lane >> 5u], bit);
            if (largest && here >= order_of(picture.amount, magnitude)) atomicOr(words[2u + (lane >> 5u)], bit);
        }
    }
    barrier();
    if ((lane & 31u) == 0u) {
        weak[place] = words[lane >> 5u];
        strong[place] = words[2u + (lane >> 5u)];
    }
}
