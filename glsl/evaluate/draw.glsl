// What every way of drawing the flat model shares: which image an instance is, where it lies, and what is written of a part.

#ifndef EVALUATE_DRAW
#define EVALUATE_DRAW

#include "evaluate/model.glsl"
#include "evaluate/batch.glsl"
#include "evaluate/tiles.glsl"

layout(std430, set = 0, binding = 0) readonly buffer Quads { Quad quads[]; };
layout(std430, set = 0, binding = 1) readonly buffer Placements { Placement placements[]; };
layout(std430, set = 0, binding = 2) readonly buffer Tiles {
    vec2 to_clip;
    ViewTiles tiles[];
};

// PACK_MAX draws all images at once, each in its own channel; PACK_DEPTH those of one channel.
layout(constant_id = 0) const uint PACKING = 0u;
layout(constant_id = 1) const uint CHANNEL = 0u;

struct Placed {
    uint image;
    bool is_drawn;
    Placement placement;
    uint base; // the word of a filled pixel
    uint edge; // what a border pixel adds
    float depth;
};

// The image of an instance and the part at `place` from its nearest on.
Placed placed(uint instance, uint place) {
    uint packing = PACKING;
    uint channel = CHANNEL;
    Placed result;
    uint view = instance % batch.views;
    uint candidate = instance / batch.views;
    if (packing == PACK_MAX) {
        channel = candidate % CANDIDATES_A_TILE;
    } else {
        candidate = CANDIDATES_A_TILE * candidate + channel;
    }
    result.is_drawn = candidate < batch.candidates;
    result.image = candidate * batch.views + view;
    result.placement.shift = ivec2(0);
    result.placement.low = 0u;
    result.placement.high = 0u;
    result.base = 0u;
    result.edge = 0u;
    result.depth = 0.0;
    if (result.is_drawn) {
        result.placement = placements[result.image];
        uint at = result.image * batch.parts + place;
        result.is_drawn = quads[at].drawn == 1u && result.placement.low != result.placement.high;
        if (packing == PACK_MAX) {
            // The nearer the larger, an edge above its own fill: the largest value is the picture, in any order.
            result.base = (2u * (batch.parts - place)) << (8u * channel);
            result.edge = 1u << (8u * channel);
        } else {
            // All channels alike: the write mask picks one. A later channel is nearer than all of an earlier one.
            result.base = quads[at].label * 0x01010101u;
            result.edge = 0x80808080u;
            float depth = (float(place) + 0.5) / float(batch.parts);
            result.depth = (float(3u - channel) + depth) * 0.25;
        }
    }
    return result;
}

// Pixel coordinates of the framebuffer, whole numbers at pixel centres, to clip space.
vec4 to_clip_space(vec2 pixel, float depth) {
    return vec4((pixel + 0.5) * to_clip - 1.0, depth, 1.0);
}

const vec4 NOWHERE = vec4(2.0, 2.0, 0.0, 1.0);

#endif
