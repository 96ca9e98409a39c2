#version 450
#extension GL_GOOGLE_include_directive : require

// The fitness of soft evidence.

#define EVIDENCE
#include "evaluate/objective.glsl"
