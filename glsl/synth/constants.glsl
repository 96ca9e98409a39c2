// Numbers that the shaders and the library share.

#ifndef SYNTH_CONSTANTS
#define SYNTH_CONSTANTS

// Pixels a side of a tile, and so of a workgroup.
const uint TILE_SIDE = 8u;
// Cells a side of the grid of shadow on the floor, and their width, mm.
const uint SHADOW_SIDE = 130u;
const float SHADOW_CELL = 22.0;
// What a primitive is made of.
const uint LOOK_SKIN = 0u;
const uint LOOK_FACE = 1u;
const uint LOOK_HAIR = 2u;
const uint LOOK_SHIRT = 3u;
const uint LOOK_TROUSERS = 4u;
const uint LOOK_SHOE = 5u;
// A candidate of a tile: the member above, the primitive's number in the bits below.
const uint MEMBER_SHIFT = 28u;

#endif
