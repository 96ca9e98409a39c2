// Numbers that the shaders and the library share.

#ifndef TEXTURE_CONSTANTS
#define TEXTURE_CONSTANTS

// Coordinates beyond 1e25 count as this, as their bits.
const uint FARTHEST_BITS = 0x69045951u;

// Materials, as the library numbers them; 0 is none. Scenes' stages have those up to MATERIALS_OF_CLOTHES.
const uint MATERIAL_CLOUDS = 1u;
const uint MATERIAL_LAVA = 2u;
const uint MATERIAL_MARBLE = 3u;
const uint MATERIAL_GRANITE = 4u;
const uint MATERIAL_WOOD = 5u;
const uint MATERIAL_BRICK = 6u;
const uint MATERIAL_FABRIC = 7u;
const uint MATERIAL_TIMBER = 8u;
const uint MATERIALS_OF_CLOTHES = 8u;
const uint MATERIAL_GRASS = 9u;
const uint MATERIAL_SKIN = 10u;
const uint MATERIAL_FRACTAL = 11u;
const uint MATERIAL_TERRAIN = 12u;
// Numbers, sums of noise and octaves of them all that describe a material at most.
const uint MATERIAL_NUMBERS = 24u;
const uint MATERIAL_SUMS = 4u;
const uint MATERIAL_OCTAVES = 16u;

// What a picture of a material shows: its colours, its heights, its colours where rays meet a lit object.
const uint SHOWS_COLOURS = 0u;
const uint SHOWS_HEIGHTS = 1u;
const uint SHOWS_RAYS = 2u;

// What a pass of mid-point displacement does: middles of squares, middles of sides, the least and the greatest height, all to [0, 1].
const uint DISPLACES_SQUARES = 0u;
const uint DISPLACES_SIDES = 1u;
const uint DISPLACES_EXTREMES = 2u;
const uint DISPLACES_SCALING = 3u;

#endif
