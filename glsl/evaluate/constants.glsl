// Numbers that the shaders and the library share.

#ifndef EVALUATE_CONSTANTS
#define EVALUATE_CONSTANTS

// Invocations of a workgroup of the projection; also the most parts that a body may have there.
const uint PROJECT_GROUP = 128u;

// Invocations of a workgroup that draws and compares an image, a row each; a power of two.
const uint RASTER_GROUP = 64u;

#endif
