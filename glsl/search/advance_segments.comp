#version 450
#extension GL_GOOGLE_include_directive : require

// An iteration of a swarm by the fitness of silhouettes in segments.

#define SEGMENTED
#include "search/advance.glsl"
