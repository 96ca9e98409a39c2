#version 450
#extension GL_GOOGLE_include_directive : require

// The mesh drawn and compared with the evidence of what is drawn.

#define EVIDENCE
#include "evaluate/raster_mesh.glsl"
#include "evaluate/raster_sums.glsl"
