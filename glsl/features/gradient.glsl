// First derivatives of the smoothed picture, and how they become one magnitude: all in whole numbers.

#ifndef FEATURES_GRADIENT
#define FEATURES_GRADIENT

#include "features/constants.glsl"
#include "features/picture.glsl"

layout(std430, set = 0, binding = 0) readonly buffer Smoothed { uint smoothed[]; };

int at(int x, int y) {
    uint column = uint(clamp(x, 0, int(picture.width) - 1));
    uint row = uint(clamp(y, 0, int(picture.height) - 1));
    return int(smoothed[row * picture.width + column]);
}

// Differences over two pixels, weighted across by (outer middle outer): Sobel has 1 2 1.
ivec2 separable(int x, int y, int outer, int middle) {
    int gx = outer * (at(x + 1, y - 1) - at(x - 1, y - 1) + at(x + 1, y + 1) - at(x - 1, y + 1)) + middle * (at(x + 1, y) - at(x - 1, y));
    int gy = outer * (at(x - 1, y + 1) - at(x - 1, y - 1) + at(x + 1, y + 1) - at(x + 1, y - 1)) + middle * (at(x, y + 1) - at(x, y - 1));
    return ivec2(gx, gy);
}

// A number that orders gradients as their magnitudes do: the magnitude, or its square where that is exact.
int order(ivec2 g, uint magnitude) {
    if (magnitude == MAGNITUDE_EXACT) return g.x * g.x + g.y * g.y;
    if (magnitude == MAGNITUDE_SUM) return abs(g.x) + abs(g.y);
    return max(abs(g.x), abs(g.y));
}

int order_of(int threshold, uint magnitude) {
    return magnitude == MAGNITUDE_EXACT ? threshold * threshold : threshold;
}

#endif
