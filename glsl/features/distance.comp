#version 450
#extension GL_GOOGLE_include_directive : require

// The distance to the nearest edge (METHOD A5.3) from the vertical distances of the row. For a given |dx| every metric grows with
// |dy|, so that the nearest edge of each column is all there is to ask for.

#include "features/constants.glsl"
#include "features/picture.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Reach { uint reach[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Codes { uint codes[]; };

layout(constant_id = 0) const uint METRIC = 0u;

uint code(uint dx, uint dy, uint metric) {
    if (metric == METRIC_CHESSBOARD) return max(dx, dy);
    if (metric == METRIC_CITY_BLOCK) return dx + dy;
    if (metric == METRIC_EUCLIDEAN) return dx * dx + dy * dy;
    return STEP_STRAIGHT * (max(dx, dy) - min(dx, dy)) + STEP_DIAGONAL * min(dx, dy);
}

void main() {
    int x = int(gl_GlobalInvocationID.x);
    int y = int(gl_GlobalInvocationID.y);
    if (x >= int(picture.width)) return;
    uint metric = METRIC;
    uint row = uint(y) * picture.width;
    uint nearest = code(picture.limit, 0u, metric);
    for (uint dx = 0u; dx < picture.limit; dx++) {
        // Farther columns are no nearer than their own distance.
        if (code(dx, 0u, metric) >= nearest) break;
        int left = x - int(dx);
        int right = x + int(dx);
        if (left >= 0) {
            uint dy = reach[row + uint(left)];
            if (dy < picture.limit) nearest = min(nearest, code(dx, dy, metric));
        }
        if (right < int(picture.width)) {
            uint dy = reach[row + uint(right)];
            if (dy < picture.limit) nearest = min(nearest, code(dx, dy, metric));
        }
    }
    codes[row + uint(x)] = nearest;
}
