#version 450
#extension GL_GOOGLE_include_directive : require

// Gives every run its root's label and every root its area; lists the roots, or marks those that touch what they must (a second
// picture) or must not (the border).

#include "features/components.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Image { uint image[]; };
layout(std430, set = 0, binding = 1) readonly buffer Strong { uint strong[]; };
layout(std430, set = 0, binding = 2) coherent buffer Labels { uint labels[]; };
layout(std430, set = 0, binding = 3) buffer Areas { uint areas[]; };
// Their number, then their nodes, in any order.
layout(std430, set = 0, binding = 4) buffer Roots { uint roots[]; };

layout(constant_id = 0) const uint KEEP = 0u;

void main() {
    uint place = flat_place();
    if (place >= push.stride * push.height) return;
    uint keep = KEEP;
    uint column = place % push.stride;
    uint row = place / push.stride;
    uint rest = image[place];
    // The pixels of the word that decide.
    uint marks = 0u;
    if (keep == KEEP_TOUCHED) marks = strong[place];
    if (keep == KEEP_HOLES) {
        uint inside = inside_word(column, push.width);
        rest = ~rest & inside;
        if (row == 0u || row + 1u == push.height) marks = inside;
        if (column == 0u) marks |= 1u;
        uint last = push.width - 1u;
        if (column == last >> 5u) marks |= 1u << (last & 31u);
    }
    while (rest != 0u) {
        uint run = first_run(rest);
        rest &= ~run;
        uint here = node(place, uint(findLSB(run)));
        uint root = here;
        uint next = labels[root];
        while (next != root) {
            root = next;
            next = labels[root];
        }
        labels[here] = root;
        atomicAdd(areas[root], uint(bitCount(run)));
        if ((run & marks) != 0u) atomicOr(areas[root], MARK);
        if (keep == KEEP_LARGEST && root == here) {
            uint count = atomicAdd(roots[0], 1u);
            roots[1u + count] = root;
        }
    }
}
