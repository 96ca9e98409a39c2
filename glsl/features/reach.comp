#version 450
#extension GL_GOOGLE_include_directive : require

// How far above or below each pixel the nearest edge of its column is, at most the limit.

#include "features/constants.glsl"
#include "features/picture.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Edges { uint edges[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Reach { uint reach[]; };

bool is_edge(int x, int y) {
    if (y < 0 || y >= int(picture.height)) return false;
    return ((edges[uint(y) * picture.stride + (uint(x) >> 5u)] >> (uint(x) & 31u)) & 1u) != 0u;
}

void main() {
    int x = int(gl_GlobalInvocationID.x);
    int y = int(gl_GlobalInvocationID.y);
    if (x >= int(picture.width)) return;
    int found = 0;
    while (found < int(picture.limit) && !is_edge(x, y - found) && !is_edge(x, y + found)) found++;
    reach[uint(y) * picture.width + uint(x)] = uint(found);
}
