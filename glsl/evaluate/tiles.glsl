// Where candidate images lie in the framebuffer: four candidates of a view share a tile, one a channel (METHOD A9).

#ifndef EVALUATE_TILES
#define EVALUATE_TILES

// The tiles of one view: rows of `per_row` tiles, group of four after group of four.
struct ViewTiles {
    uvec2 origin; // of the first tile, framebuffer pixels
    uvec2 size;   // of a tile, framebuffer pixels, the width a multiple of four
    uint per_row;
    uint whole;   // 1 when a tile shows the picture from its origin on, whatever the candidate touches
};

// Where one image lies.
struct Placement {
    ivec2 shift; // from picture to framebuffer pixels, whole words of four in x from the tile's origin
    uint low;    // what it may touch, framebuffer pixels: left | top << 16
    uint high;   // right | bottom << 16, exclusive; the same as `low` when nothing is to be drawn
};

const uint CANDIDATES_A_TILE = 4u;

uvec2 tile_origin(ViewTiles tiles, uint group) {
    return tiles.origin + uvec2(group % tiles.per_row, group / tiles.per_row) * tiles.size;
}

ivec2 unpack_place(uint place) {
    return ivec2(place & 0xffffu, place >> 16);
}

#endif
