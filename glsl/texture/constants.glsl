// Numbers that the shaders and the library share.

#ifndef TEXTURE_CONSTANTS
#define TEXTURE_CONSTANTS

// Coordinates beyond 1e25 count as this, as their bits.
const uint FARTHEST_BITS = 0x69045951u;

// Materials that stages have, as the library numbers them; 0 is none.
const uint MATERIAL_CLOUDS = 1u;
const uint MATERIAL_LAVA = 2u;
const uint MATERIAL_MARBLE = 3u;
const uint MATERIAL_GRANITE = 4u;
const uint MATERIAL_WOOD = 5u;
const uint MATERIAL_BRICK = 6u;
const uint MATERIAL_FABRIC = 7u;
const uint MATERIAL_TIMBER = 8u;
// Lattices of a material's space, its own first, and numbers that describe a material at most.
const uint MATERIAL_LATTICES = 9u;
const uint MATERIAL_NUMBERS = 16u;

#endif
