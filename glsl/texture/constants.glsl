// Numbers that the shaders and the library share.

#ifndef TEXTURE_CONSTANTS
#define TEXTURE_CONSTANTS

// Coordinates beyond 1e25 count as this, as their bits.
const uint FARTHEST_BITS = 0x69045951u;

#endif
