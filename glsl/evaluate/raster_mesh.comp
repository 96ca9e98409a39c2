#version 450
#extension GL_GOOGLE_include_directive : require

// The mesh drawn and compared.

#include "evaluate/raster_mesh.glsl"
#include "evaluate/raster_sums.glsl"
