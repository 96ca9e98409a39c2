// Framebuffer against observation, shared by all ways of gathering a candidate's pixels: resources, and the sums of a word of
// four pixels (SPEC A6, A9).

#ifndef EVALUATE_COMPARE
#define EVALUATE_COMPARE

#include "evaluate/constants.glsl"
#include "evaluate/model.glsl"
#include "evaluate/batch.glsl"
#include "evaluate/tiles.glsl"

layout(std430, set = 0, binding = 0) readonly buffer Placements { Placement placements[]; };
layout(std430, set = 0, binding = 1) readonly buffer Tiles {
    vec2 to_clip;
    ViewTiles tiles[];
};
layout(std430, set = 0, binding = 2) readonly buffer Cameras { Camera cameras[]; };
layout(std430, set = 0, binding = 3) readonly buffer Pixels { uint pixels[]; };
layout(std430, set = 0, binding = 4) buffer AllSums { Sums sums[]; };
layout(set = 0, binding = 5) uniform utexture2D framebuffer;

// The bit of a drawn byte that says edge.
layout(constant_id = 0) const uint EDGE_BIT = 0u;

// The tile of a workgroup: what of it is in use, and what of that the workgroup takes - every nth row.
struct Tile {
    uint view;
    uint first_candidate;
    uint candidates;
    ivec2 origin;
    uint width;  // pixels in use, a multiple of four
    uint height; // rows in use
    uint row_words;
    uint first_word;
};

Tile own_tile() {
    Tile tile;
    uint group = gl_WorkGroupID.x / batch.views;
    tile.view = gl_WorkGroupID.x % batch.views;
    tile.first_candidate = group * CANDIDATES_A_TILE;
    tile.candidates = min(CANDIDATES_A_TILE, batch.candidates - tile.first_candidate);
    tile.origin = ivec2(tile_origin(tiles[tile.view], group));
    ivec2 high = tile.origin;
    for (uint channel = 0u; channel < tile.candidates; channel++) {
        Placement placement = placements[(tile.first_candidate + channel) * batch.views + tile.view];
        high = max(high, unpack_place(placement.high));
    }
    tile.width = (uint(high.x - tile.origin.x) + 3u) & ~3u;
    tile.height = uint(high.y - tile.origin.y);
    tile.row_words = (cameras[tile.view].size.x + 3u) >> 2;
    tile.first_word = cameras[tile.view].first_pixel_word;
    return tile;
}

// Rows that this workgroup takes of `tile`.
uint own_rows(Tile tile) {
    uint bands = gl_NumWorkGroups.y;
    return (tile.height + bands - 1u - gl_WorkGroupID.y) / bands;
}

// Where the observation of channel `channel` begins for the tile's origin, in words: it may lie outside of the picture where
// nothing is drawn.
int observed_from(Tile tile, uint channel) {
    if (channel >= tile.candidates) return 0;
    Placement placement = placements[(tile.first_candidate + channel) * batch.views + tile.view];
    ivec2 low = tile.origin - placement.shift;
    return int(tile.first_word) + low.y * int(tile.row_words) + (low.x >> 2);
}

// The observed word at `place`; anything where nothing is drawn.
uint observed(int place) {
    return pixels[clamp(place, 0, int(pixels.length()) - 1)];
}

// Adds four pixels of one candidate: their drawn bytes and their observed ones.
void add_word(uint drawn, uint seen, inout uvec4 total) {
    uint edge_bit = EDGE_BIT;
    uint filled = (((drawn & 0x7f7f7f7fu) + 0x7f7f7f7fu) | drawn) & 0x80808080u;
    uint edges = (drawn >> edge_bit) & 0x01010101u;
    uint near = seen & (edges * 0x7fu);
    total.x += uint(bitCount(filled));
    total.y += uint(bitCount(filled & seen));
    total.z += uint(bitCount(edges));
    uint pairs = (near & 0x00ff00ffu) + ((near >> 8) & 0x00ff00ffu);
    total.w += (pairs & 0xffffu) + (pairs >> 16);
}

void add_to_sums(Tile tile, uint channel, uvec4 total) {
    if (channel >= tile.candidates || total.x == 0u) return;
    uint image = (batch.first + tile.first_candidate + channel) * batch.views + tile.view;
    atomicAdd(sums[image].area_model, total.x);
    atomicAdd(sums[image].overlap, total.y);
    atomicAdd(sums[image].edges, total.z);
    atomicAdd(sums[image].proximity, total.w);
}

#endif
