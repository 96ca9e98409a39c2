#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Compares silhouettes in segments through shared memory.

#define SEGMENTED
#include "evaluate/compare_shared.glsl"
