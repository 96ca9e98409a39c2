#version 450
#extension GL_GOOGLE_include_directive : require

// The fitness of silhouettes in segments.

#define SEGMENTED
#include "evaluate/objective.glsl"
