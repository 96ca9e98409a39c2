#version 450
#extension GL_GOOGLE_include_directive : require

// Draws the components that are kept; holes into the picture they are holes of.

#include "features/components.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Image { uint image[]; };
layout(std430, set = 0, binding = 1) readonly buffer Labels { uint labels[]; };
layout(std430, set = 0, binding = 2) readonly buffer Areas { uint areas[]; };
layout(std430, set = 0, binding = 3) writeonly buffer Kept { uint kept[]; };

layout(constant_id = 0) const uint KEEP = 0u;

void main() {
    uint place = flat_place();
    if (place >= push.stride * push.height) return;
    uint keep = KEEP;
    uint before = image[place];
    bool holes = keep == KEEP_HOLES;
    uint rest = holes ? ~before & inside_word(place % push.stride, push.width) : before;
    uint drawn = holes ? before : 0u;
    while (rest != 0u) {
        uint run = first_run(rest);
        rest &= ~run;
        uint area = areas[labels[node(place, uint(findLSB(run)))]];
        bool marked = (area & MARK) != 0u;
        if (holes ? !marked && area <= push.most : marked) drawn |= run;
    }
    kept[place] = drawn;
}
