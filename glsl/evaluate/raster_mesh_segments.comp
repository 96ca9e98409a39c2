#version 450
#extension GL_GOOGLE_include_directive : require

// The mesh drawn and compared segment by segment.

#define SEGMENTED
#include "evaluate/raster_mesh.glsl"
#include "evaluate/raster_sums.glsl"
