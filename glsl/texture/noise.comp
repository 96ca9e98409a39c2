#version 450
#extension GL_GOOGLE_include_directive : require

// A sum of octaves at each of a list of points, and the lattice's word at the point's cell in the first octave.

#include "texture/octaves.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 3) writeonly buffer Values { float values[]; };
layout(std430, set = 0, binding = 4) writeonly buffer Words { uint words[]; };

layout(push_constant) uniform Push {
    uint count;
    uint octaves;
} push;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) return;
    uint word;
    values[i] = octave_sum(points[i], push.octaves, word);
    words[i] = word;
}
