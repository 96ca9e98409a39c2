#version 450
#extension GL_GOOGLE_include_directive : require

// An iteration of a swarm by the fitness of whole silhouettes.

#define SILHOUETTES
#include "search/advance.glsl"
