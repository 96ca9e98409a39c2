#version 450
#extension GL_GOOGLE_include_directive : require

// The last distribution's mean and standard deviation. One invocation a degree of freedom.

#include "search/constants.glsl"
#include "search/frame.glsl"
#include "search/outcome.glsl"
#include "search/evolution.glsl"

layout(local_size_x = SEARCH_GROUP) in;

layout(std430, set = 0, binding = 3) readonly buffer Matrix { float matrix[]; };

layout(push_constant) uniform Push {
    uint dofs;
} push;

void main() {
    uint d = gl_GlobalInvocationID.x;
    if (d >= push.dofs) return;
    precise float square = 0.0;
    for (uint column = 0u; column < push.dofs; column++) {
        float entry = matrix[column * push.dofs + d];
        precise float squared = entry * entry;
        square = square + squared;
    }
    precise float deviation = evolution.sigma * root(square) * frame.values[push.dofs + d];
    outcome.values[push.dofs + d] = deviation;
    outcome.values[2u * push.dofs + d] = pose_at(evolution.values[d], d, push.dofs);
}
