#version 450
#extension GL_GOOGLE_include_directive : require

// Joins the runs of a word with those beside and above them; of holes not diagonally.

#include "features/components.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Image { uint image[]; };
layout(std430, set = 0, binding = 1) coherent buffer Labels { uint labels[]; };

layout(constant_id = 0) const uint KEEP = 0u;

uint find(uint at) {
    uint next = labels[at];
    while (next != at) {
        at = next;
        next = labels[at];
    }
    return at;
}

// A label that is out of date when it is read still names a node of the same component. That a root was one when it was given
// away is what the exchange tells.
void join(uint a, uint b) {
    while (true) {
        a = find(a);
        b = find(b);
        if (a == b) return;
        uint later = max(a, b);
        uint earlier = min(a, b);
        uint before = atomicMin(labels[later], earlier);
        if (before == later) return;
        a = before;
        b = earlier;
    }
}

uint word(uint place, uint column, uint keep) {
    uint value = image[place];
    return keep == KEEP_HOLES ? ~value & inside_word(column, push.width) : value;
}

void main() {
    uint place = flat_place();
    if (place >= push.stride * push.height) return;
    uint keep = KEEP;
    uint column = place % push.stride;
    bool has_above = place >= push.stride;
    uint rest = word(place, column, keep);
    if (rest == 0u) return;
    uint beside = column > 0u ? word(place - 1u, column - 1u, keep) : 0u;
    uint above = has_above ? word(place - push.stride, column, keep) : 0u;
    uint above_left = 0u;
    uint above_right = 0u;
    if (keep != KEEP_HOLES && has_above) {
        if (column > 0u) above_left = word(place - push.stride - 1u, column - 1u, keep);
        if (column + 1u < push.stride) above_right = word(place - push.stride + 1u, column + 1u, keep);
    }
    while (rest != 0u) {
        uint run = first_run(rest);
        rest &= ~run;
        uint here = node(place, uint(findLSB(run)));
        if ((run & 1u) != 0u) {
            if ((beside >> 31u) != 0u) join(here, node(place - 1u, run_start(beside, 31u)));
            if ((above_left >> 31u) != 0u) join(here, node(place - push.stride - 1u, run_start(above_left, 31u)));
        }
        if ((run >> 31u) != 0u && (above_right & 1u) != 0u) join(here, node(place - push.stride + 1u, 0u));
        uint reach = keep == KEEP_HOLES ? run : run | (run << 1u) | (run >> 1u);
        uint met = above & reach;
        while (met != 0u) {
            join(here, node(place - push.stride, run_start(above, uint(findLSB(met)))));
            met &= ~first_run(met);
        }
    }
}
