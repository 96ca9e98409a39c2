#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Compares silhouettes in segments without any exchange.

#define SEGMENTED
#include "evaluate/compare_texels.glsl"
