#version 450
#extension GL_GOOGLE_include_directive : require

// Counts the ratios of a picture to its background over a grid of pixels, channel by channel.

#include "features/constants.glsl"
#include "features/place.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Colours { uint colours[]; };
// The background's colours on the grid: red, green, blue from the lowest byte on.
layout(std430, set = 0, binding = 1) readonly buffer Background { uint background[]; };
layout(std430, set = 0, binding = 2) buffer Counts { uint counts[]; };

layout(push_constant) uniform Ratios {
    uint width;
    uint height;
} push;

const uint PIXELS_EACH = 16u;

shared uint here[3u * RATIO_COUNTS];

uint byte_at(uint at) {
    return (colours[at >> 2u] >> (8u * (at & 3u))) & 255u;
}

void main() {
    uint lane = gl_LocalInvocationID.x;
    for (uint i = lane; i < 3u * RATIO_COUNTS; i += ROW_GROUP) here[i] = 0u;
    barrier();
    uint columns = (push.width + RATIO_GRID - 1u) / RATIO_GRID;
    uint rows = (push.height + RATIO_GRID - 1u) / RATIO_GRID;
    uint first = (flat_place() - lane) * PIXELS_EACH + lane;
    for (uint i = 0u; i < PIXELS_EACH; i++) {
        uint place = first + i * ROW_GROUP;
        if (place >= columns * rows) break;
        uint at = 3u * (place / columns * RATIO_GRID * push.width + place % columns * RATIO_GRID);
        for (uint channel = 0u; channel < 3u; channel++) {
            uint seen = byte_at(at + channel);
            uint behind = (background[place] >> (8u * channel)) & 255u;
            // Dark pixels say nothing about a ratio, and saturated ones lie.
            if (behind < 32u || behind > 235u || seen > 250u) continue;
            uint ratio = (seen * RATIO_STEPS + behind / 2u) / behind;
            if (ratio < RATIO_COUNTS) atomicAdd(here[channel * RATIO_COUNTS + ratio], 1u);
        }
    }
    barrier();
    for (uint i = lane; i < 3u * RATIO_COUNTS; i += ROW_GROUP) {
        uint count = here[i];
        if (count != 0u) atomicAdd(counts[i], count);
    }
}
