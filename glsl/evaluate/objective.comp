#version 450
#extension GL_GOOGLE_include_directive : require

// The fitness of whole silhouettes.

#include "evaluate/objective.glsl"
