#version 460
// What double.comp does, with the same bindings, and to its source as well.

#include "gpu/constants.glsl"

layout(local_size_x = DOUBLE_WORKGROUP) in;

layout(set = 0, binding = 0) buffer Source { float source[]; };
layout(set = 0, binding = 1) writeonly buffer Target { float target[]; };

layout(push_constant) uniform DoublePush {
    uint count;
    float factor;
} push;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) return;
    source[i] *= push.factor;
    target[i] = source[i];
}
