// Numbers that the shaders and the library share.

#ifndef EVALUATE_CONSTANTS
#define EVALUATE_CONSTANTS

// Invocations of a workgroup of the projection; also the most parts that a body may have there.
const uint PROJECT_GROUP = 128u;

// Invocations of a workgroup that draws and compares an image, a row each; a power of two.
const uint RASTER_GROUP = 32u;

// Invocations of a workgroup of the objective.
const uint OBJECTIVE_GROUP = 64u;
// Kinds of objective.
const uint OBJECTIVE_WS = 0u;
const uint OBJECTIVE_SP = 1u;
const uint OBJECTIVE_AOWS = 2u;
const uint OBJECTIVE_AOSP = 3u;
const uint OBJECTIVE_POSP = 4u;

#endif
