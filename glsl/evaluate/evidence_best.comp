#version 450
#extension GL_GOOGLE_include_directive : require

// What no drawing can exceed in a view: of every pixel the code of the class that it speaks for most, less that which says nothing. An
// invocation adds up 32 pixels, all at once, by the bits of their codes.

#include "evaluate/constants.glsl"
#include "features/constants.glsl"
#include "features/place.glsl"

layout(local_size_x = 64) in;

// The bits of the codes of 32 pixels of a row, [group][class].
layout(std430, set = 0, binding = 0) readonly buffer EvidencePlanes { uvec4 evidence_planes[]; };
// [view]
layout(std430, set = 0, binding = 1) buffer BestEvidence { uint best_evidence[]; };

layout(push_constant) uniform EvidenceBest {
    uint first_group;
    uint groups;
    uint view;
    uint classes;
} push;

shared uint total;

void main() {
    uint lane = gl_LocalInvocationID.x;
    if (lane == 0u) total = 0u;
    barrier();
    uint group = flat_place();
    if (group < push.groups) {
        uvec4 most = uvec4(0u);
        for (uint class_ = 0u; class_ < push.classes; class_++) {
            uvec4 own = evidence_planes[(push.first_group + group) * push.classes + class_];
            uint larger = 0u;
            uint equal = 0xffffffffu;
            for (int bit = 3; bit >= 0; bit--) {
                larger |= equal & own[bit] & ~most[bit];
                equal &= ~(own[bit] ^ most[bit]);
            }
            most = (own & larger) | (most & ~larger);
        }
        // From 8 on a code has bit 3, and is one more than its other bits over what says nothing.
        uvec3 over = most.xyz & most.w;
        uint sum = uint(bitCount(most.w) + bitCount(over.x) + 2 * bitCount(over.y) + 4 * bitCount(over.z));
        if (sum != 0u) atomicAdd(total, sum);
    }
    barrier();
    if (lane == 0u && total != 0u) atomicAdd(best_evidence[push.view], total);
}
