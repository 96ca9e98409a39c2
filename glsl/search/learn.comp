#version 450
#extension GL_GOOGLE_include_directive : require

// What a generation teaches by the fitness that a stage before has made.

#include "search/learn.glsl"
