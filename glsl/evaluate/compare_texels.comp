#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Compares whole silhouettes without any exchange.

#include "evaluate/compare_texels.glsl"
