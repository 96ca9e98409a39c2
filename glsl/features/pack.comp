#version 450
#extension GL_GOOGLE_include_directive : require

// Distances to proximities (METHOD A5.4), packed with the silhouette (METHOD A5.5): four pixels an invocation.

#include "features/constants.glsl"
#include "features/picture.glsl"
#include "features/place.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Silhouette { uint silhouette[]; };
layout(std430, set = 0, binding = 1) readonly buffer Codes { uint codes[]; };
// The proximity of each code, a byte each.
layout(std430, set = 0, binding = 2) readonly buffer Proximity { uint proximity[]; };
layout(std430, set = 0, binding = 3) writeonly buffer Packed { uint observation[]; };

void main() {
    uint pixels = picture.width * picture.height;
    uint place = flat_place();
    if (place * 4u >= pixels) return;
    uint word = 0u;
    for (uint i = 0u; i < 4u; i++) {
        uint pixel = place * 4u + i;
        if (pixel >= pixels) break;
        uint x = pixel % picture.width;
        uint y = pixel / picture.width;
        uint code = codes[pixel];
        uint value = (proximity[code >> 2u] >> (8u * (code & 3u))) & 127u;
        uint inside = (silhouette[y * picture.stride + (x >> 5u)] >> (x & 31u)) & 1u;
        word |= (value | (inside << 7u)) << (8u * i);
    }
    observation[place] = word;
}
