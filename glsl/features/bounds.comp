#version 450
#extension GL_GOOGLE_include_directive : require

// The smallest rectangle that holds every set pixel. Each side is kept as a distance that grows as the rectangle does, 0 when nothing
// is set: of left and top from the opposite border.

#include "features/constants.glsl"
#include "features/place.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Image { uint image[]; };
// Width less the first column, height less the first row, one past the last column, one past the last row.
layout(std430, set = 0, binding = 1) buffer Sides { uint sides[]; };

layout(push_constant) uniform Bounds {
    uint width;
    uint height;
    uint stride;
} push;

shared uint here[4];

void main() {
    uint lane = gl_LocalInvocationID.x;
    if (lane < 4u) here[lane] = 0u;
    barrier();
    uint place = flat_place();
    uint word = 0u;
    if (place < push.stride * push.height) word = image[place];
    if (word != 0u) {
        uint column = place % push.stride * 32u;
        uint row = place / push.stride;
        atomicMax(here[0], push.width - (column + uint(findLSB(word))));
        atomicMax(here[1], push.height - row);
        atomicMax(here[2], column + uint(findMSB(word)) + 1u);
        atomicMax(here[3], row + 1u);
    }
    barrier();
    if (lane < 4u && here[lane] != 0u) atomicMax(sides[lane], here[lane]);
}
