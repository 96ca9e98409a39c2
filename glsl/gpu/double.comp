#version 460
// Multiplies every value of an array by a factor.

#include "gpu/constants.glsl"

layout(local_size_x = DOUBLE_WORKGROUP) in;

layout(set = 0, binding = 0) readonly buffer Source { float source[]; };
layout(set = 0, binding = 1) writeonly buffer Target { float target[]; };

layout(push_constant) uniform Push {
    uint count;
    float factor;
} push;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) return;
    target[i] = push.factor * source[i];
}
