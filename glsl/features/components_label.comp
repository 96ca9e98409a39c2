#version 450
#extension GL_GOOGLE_include_directive : require

// Makes every run of a word a component of its own.

#include "features/components.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Image { uint image[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Labels { uint labels[]; };
layout(std430, set = 0, binding = 2) writeonly buffer Areas { uint areas[]; };
layout(std430, set = 0, binding = 3) writeonly buffer Roots { uint roots[]; };

layout(constant_id = 0) const uint KEEP = 0u;

void main() {
    uint place = flat_place();
    if (place == 0u) roots[0] = 0u;
    if (place >= push.stride * push.height) return;
    uint keep = KEEP;
    uint rest = image[place];
    if (keep == KEEP_HOLES) rest = ~rest & inside_word(place % push.stride, push.width);
    while (rest != 0u) {
        uint at = node(place, uint(findLSB(rest)));
        labels[at] = at;
        areas[at] = 0u;
        rest &= ~first_run(rest);
    }
}
