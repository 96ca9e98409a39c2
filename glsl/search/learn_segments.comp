#version 450
#extension GL_GOOGLE_include_directive : require

// What a generation teaches by the fitness of silhouettes in segments.

#define SEGMENTED
#include "search/learn.glsl"
