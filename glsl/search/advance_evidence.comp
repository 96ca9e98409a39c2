#version 450
#extension GL_GOOGLE_include_directive : require

// An iteration of a swarm by the fitness of soft evidence.

#define EVIDENCE
#include "search/advance.glsl"
