#version 450
#extension GL_GOOGLE_include_directive : require

// The flat model drawn and compared segment by segment, in two phases.

#define SEGMENTED
#include "evaluate/raster_spans.glsl"
#include "evaluate/raster_sums.glsl"
