#version 450
#extension GL_GOOGLE_include_directive : require

// The codes of every pixel as a word a pixel, from their bits: four neighbouring pixels an invocation.

#include "evaluate/constants.glsl"
#include "features/constants.glsl"
#include "features/place.glsl"

layout(local_size_x = 64) in;

// Whether pixels are ignored.
layout(constant_id = 0) const bool IGNORES = false;

// The bits of the codes of 32 pixels of a row, [group][class].
layout(std430, set = 0, binding = 0) readonly buffer EvidencePlanes { uvec4 evidence_planes[]; };
// A bit a pixel, as the observations' planes.
layout(std430, set = 0, binding = 1) readonly buffer CountedPlanes { uint counted_planes[]; };
// Placed as the packed observations.
layout(std430, set = 0, binding = 2) writeonly buffer EvidencePixels { uvec4 evidence_pixels[]; };

layout(push_constant) uniform EvidenceWords {
    uint width;
    uint height;
    uint first_group;
    uint first_word; // of the packed observation
    uint classes;
} push;

void main() {
    uint place = flat_place();
    uint fours = (push.width + 3u) / 4u;
    if (place >= fours * push.height) return;
    uint y = place / fours;
    uint x = place % fours * 4u;
    uint group = push.first_group + y * ((push.width + 31u) / 32u) + (x >> 5u);
    uint counted = IGNORES ? counted_planes[group] : 0xffffffffu;
    uvec4 words = uvec4(0u);
    for (uint i = 0u; i < 4u; i++) {
        if (x + i >= push.width) break;
        uint bit = (x + i) & 31u;
        for (uint class_ = 0u; class_ < push.classes; class_++) {
            uvec4 bits = (evidence_planes[group * push.classes + class_] >> bit) & 1u;
            words[i] |= (bits.x | (bits.y << 1u) | (bits.z << 2u) | (bits.w << 3u)) << (4u * class_);
        }
        // What is ignored says nothing of any class.
        if (((counted >> bit) & 1u) == 0u) words[i] = 0x11111111u * EVIDENCE_NEUTRAL;
    }
    evidence_pixels[push.first_word + place] = words;
}
