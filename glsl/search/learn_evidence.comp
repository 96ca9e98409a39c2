#version 450
#extension GL_GOOGLE_include_directive : require

// What a generation teaches by the fitness of soft evidence.

#define EVIDENCE
#include "search/learn.glsl"
