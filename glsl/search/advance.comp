#version 450
#extension GL_GOOGLE_include_directive : require

// An iteration of a swarm by the fitness that a stage before has made.

#include "search/advance.glsl"
