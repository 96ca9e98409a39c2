#version 450
#extension GL_GOOGLE_include_directive : require

// Finds every image its place in the framebuffer, clears its sums, and lists the images that do not fit their tile: those are
// scored without a framebuffer.

#include "evaluate/constants.glsl"
#include "evaluate/model.glsl"
#include "evaluate/batch.glsl"
#include "evaluate/tiles.glsl"

layout(local_size_x = PLACE_GROUP) in;

layout(std430, set = 0, binding = 0) readonly buffer AllBounds { Bounds bounds[]; };
layout(std430, set = 0, binding = 1) readonly buffer Tiles {
    vec2 to_clip; // from framebuffer pixels to clip space, before 1 is taken off
    ViewTiles tiles[];
};
layout(std430, set = 0, binding = 2) readonly buffer Cameras { Camera cameras[]; };
layout(std430, set = 0, binding = 6) readonly buffer Quads { Quad quads[]; };
layout(std430, set = 0, binding = 3) writeonly buffer Placements { Placement placements[]; };
layout(std430, set = 0, binding = 4) writeonly buffer AllSums { Sums sums[]; };
// A count of workgroups for the stage that scores the listed: how many, 1, 1.
layout(std430, set = 0, binding = 5) buffer Listed {
    uint listed_count;
    uint listed_one[2];
    uint listed[];
};

void main() {
    uint image = gl_GlobalInvocationID.x;
    if (image >= batch.candidates * batch.views) return;
    uint candidate = image / batch.views;
    uint view = image % batch.views;
    Bounds own = bounds[image];
    ViewTiles tile = tiles[view];
    ivec2 origin = ivec2(tile_origin(tile, candidate / CANDIDATES_A_TILE));
    bool is_empty = own.high.x <= own.low.x || own.high.y <= own.low.y;
    if (tile.whole == 1u) {
        own.low = ivec2(0);
        own.high = ivec2(cameras[view].size);
    }
    // Whole words of four pixels, as the observation's bytes are read.
    ivec2 low = ivec2(own.low.x & ~3, own.low.y);
    ivec2 needed = own.high - low;
    bool fits = all(lessThanEqual(needed, ivec2(tile.size)));
    // Drawing multiplies pixels by a part's sides in 1/256 pixels: a part so large that 32 bits do not hold the product, which means
    // thousands of pixels, does not fit either.
    for (uint place = 0u; place < batch.parts; place++) {
        Quad quad = quads[image * batch.parts + place];
        ivec4 x = quad.x;
        ivec4 y = quad.y;
        int wide = max(max(x.x, x.y), max(x.z, x.w)) - min(min(x.x, x.y), min(x.z, x.w));
        int high = max(max(y.x, y.y), max(y.z, y.w)) - min(min(y.x, y.y), min(y.z, y.w));
        if (float(needed.x) * float(high) + float(needed.y) * float(wide) > 2.0e9) fits = false;
    }

    Placement placement;
    placement.shift = origin - low;
    placement.low = 0u;
    placement.high = 0u;
    if (fits && !is_empty) {
        uvec2 left_top = uvec2(own.low + placement.shift);
        uvec2 right_bottom = uvec2(own.high + placement.shift);
        placement.low = left_top.x | left_top.y << 16;
        placement.high = right_bottom.x | right_bottom.y << 16;
    }
    placements[image] = placement;
    if (!fits && !is_empty) listed[atomicAdd(listed_count, 1u)] = image;

    Sums none;
    none.area_model = 0u;
    none.overlap = 0u;
    none.edges = 0u;
    none.proximity = 0u;
    sums[(batch.first + candidate) * batch.views + view] = none;
}
