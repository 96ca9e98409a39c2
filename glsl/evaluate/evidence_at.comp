#version 450
#extension GL_GOOGLE_include_directive : require

// The codes of single pixels, a word each, for the host.

#include "features/constants.glsl"
#include "features/place.glsl"

layout(local_size_x = 64) in;

// Of each pixel its group of 32, and its place there.
layout(std430, set = 0, binding = 0) readonly buffer AskedPixels { uvec2 asked[]; };
// The bits of the codes of 32 pixels of a row, [group][class].
layout(std430, set = 0, binding = 1) readonly buffer EvidencePlanes { uvec4 evidence_planes[]; };
layout(std430, set = 0, binding = 2) writeonly buffer ToldCodes { uint told[]; };

layout(push_constant) uniform EvidenceAt {
    uint count;
    uint classes;
} push;

void main() {
    uint place = flat_place();
    if (place >= push.count) return;
    uvec2 pixel = asked[place];
    uint word = 0u;
    for (uint class_ = 0u; class_ < push.classes; class_++) {
        uvec4 bits = (evidence_planes[pixel.x * push.classes + class_] >> pixel.y) & 1u;
        word |= (bits.x | (bits.y << 1u) | (bits.z << 2u) | (bits.w << 3u)) << (4u * class_);
    }
    told[place] = word;
}
