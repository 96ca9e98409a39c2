#version 450
#extension GL_GOOGLE_include_directive : require

// The flat model drawn and compared with the evidence of what is drawn, in two phases.

#define EVIDENCE
#include "evaluate/raster_spans.glsl"
#include "evaluate/raster_sums.glsl"
