// Numbers that the shaders and the library share.

#ifndef MATRIX_CONSTANTS
#define MATRIX_CONSTANTS

// Side of the square of elements that a workgroup computes.
const uint TILE = 16u;
// Bits of an element at most.
const uint PLANES = 32u;

#endif
