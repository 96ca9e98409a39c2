#version 450
#extension GL_GOOGLE_include_directive : require

// Distances to proximities (METHOD A5.4), packed with the silhouette (METHOD A5.5), in both forms that evaluators on a device compare
// with: bytes, and bit planes. 32 pixels of a row an invocation.

#include "features/constants.glsl"
#include "features/picture.glsl"
#include "features/place.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Silhouette { uint silhouette[]; };
layout(std430, set = 0, binding = 1) readonly buffer Codes { uint codes[]; };
// The pixels that do not count, looked at where there are any.
layout(std430, set = 0, binding = 5) readonly buffer Ignored { uint ignored[]; };
// The proximity of each code, a byte each.
layout(std430, set = 0, binding = 2) readonly buffer Proximity { uint proximity[]; };
// Four pixels a word, rows padded to whole words.
layout(std430, set = 0, binding = 3) writeonly buffer Pixels { uint observation[]; };
// Eight words for 32 pixels of a row: planes 0..=6 the bits of the proximity, plane 7 the silhouette.
layout(std430, set = 0, binding = 4) writeonly buffer Planes { uint planes[]; };

layout(constant_id = 0) const bool IGNORES = false;

void main() {
    uint groups = (picture.width + 31u) / 32u;
    uint place = flat_place();
    if (place >= groups * picture.height) return;
    uint y = place / groups;
    uint group = place % groups;
    uint inside = silhouette[y * picture.stride + group];
    uint kept = IGNORES ? ~ignored[y * picture.stride + group] : 0xffffffffu;
    uint first_word = y * ((picture.width + 3u) / 4u) + group * 8u;
    uint own[8];
    for (uint plane = 0u; plane < 8u; plane++) own[plane] = 0u;
    for (uint four = 0u; four < 8u; four++) {
        uint first = group * 32u + four * 4u;
        if (first >= picture.width) break;
        uint word = 0u;
        for (uint i = 0u; i < 4u; i++) {
            if (first + i >= picture.width) break;
            uint code = codes[y * picture.width + first + i];
            uint bit = four * 4u + i;
            uint value = (proximity[code >> 2u] >> (8u * (code & 3u))) & 127u;
            value |= ((inside >> bit) & 1u) << 7u;
            if (((kept >> bit) & 1u) == 0u) value = 0u;
            word |= value << (8u * i);
            for (uint plane = 0u; plane < 8u; plane++) own[plane] |= ((value >> plane) & 1u) << bit;
        }
        observation[first_word + four] = word;
    }
    for (uint plane = 0u; plane < 8u; plane++) planes[8u * place + plane] = own[plane];
}
