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

// PACK_MAX and PACK_AT_ONCE draw all images at once, each in its own channel; PACK_DEPTH those of one channel.
layout(constant_id = 0) const uint PACKING = 0u;
layout(constant_id = 1) const uint CHANNEL = 0u;

struct Placed {
    uint image;
    uint place; // of the part, from the nearest on
    bool is_drawn;
    Placement placement;
    uint base; // the word of a filled pixel
    uint edge; // what a border pixel adds
    float depth;
};

// The image of an instance and its part `place`, from the nearest on; at once, in the order of the body, as they come without a list of
// depths.
Placed placed(uint instance, uint place) {
    uint packing = PACKING;
    uint channel = CHANNEL;
    Placed result;
    uint view = instance % batch.views;
    uint candidate = instance / batch.views;
    if (packing == PACK_DEPTH) {
        candidate = CANDIDATES_A_TILE * candidate + channel;
    } else {
        channel = candidate % CANDIDATES_A_TILE;
    }
    result.is_drawn = candidate < batch.candidates;
    result.image = candidate * batch.views + view;
    result.placement.shift = ivec2(0);
    result.placement.low = 0u;
    result.placement.high = 0u;
    result.base = 0u;
    result.edge = 0u;
    result.depth = 0.0;
    result.place = place;
    if (packing == PACK_AT_ONCE && result.is_drawn) {
        for (uint other = 0u; other < batch.parts; other++) {
            if (quads[result.image * batch.parts + other].part == place) result.place = other;
        }
    }
    if (result.is_drawn) {
        result.placement = placements[result.image];
        uint at = result.image * batch.parts + result.place;
        result.is_drawn = quads[at].drawn == 1u && result.placement.low != result.placement.high;
        if (packing == PACK_MAX) {
            // The nearer the larger, an edge above its own fill: the largest value is the picture, in any order.
            result.base = (2u * (batch.parts - result.place)) << (8u * channel);
            result.edge = 1u << (8u * channel);
        } else {
            // All channels alike: the write mask picks one; at once it is the own one. A later channel is nearer than all of an
            // earlier one.
            uint places = packing == PACK_DEPTH ? 0x01010101u : 1u << (8u * channel);
            result.base = quads[at].label * places;
            result.edge = 0x80u * places;
            float depth = (float(result.place) + 0.5) / float(batch.parts);
            result.depth = (float(3u - channel) + depth) * 0.25;
        }
    }
    return result;
}

// Pixel coordinates of the framebuffer, whole numbers at pixel centres, to clip space.
vec4 to_clip_space(vec2 pixel, float depth) {
    return vec4((pixel + 0.5) * to_clip - 1.0, depth, 1.0);
}

// A corner of a part as it is, for its fill.
vec4 fill_corner(Placed part, uint corner) {
    uint at = part.image * batch.parts + part.place;
    ivec2 snapped = ivec2(quads[at].x[corner], quads[at].y[corner]) + 256 * part.placement.shift;
    return to_clip_space(vec2(snapped) * (1.0 / 256.0), part.depth);
}

// The same rounded to whole pixels, for its border.
vec4 border_corner(Placed part, uint corner) {
    uint at = part.image * batch.parts + part.place;
    ivec2 rounded = ((ivec2(quads[at].x[corner], quads[at].y[corner]) + 128) >> 8) + part.placement.shift;
    return to_clip_space(vec2(rounded), part.depth);
}

const vec4 NOWHERE = vec4(2.0, 2.0, 0.0, 1.0);

#endif
