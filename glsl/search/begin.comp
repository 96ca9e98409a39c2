#version 450
#extension GL_GOOGLE_include_directive : require

// The start of a frame's evolution: round the centre, with a matrix that turns nothing. One invocation an entry of the matrix.

#include "search/constants.glsl"
#include "search/frame.glsl"
#include "search/outcome.glsl"
#include "search/evolution.glsl"

layout(local_size_x = SEARCH_GROUP) in;

layout(std430, set = 0, binding = 3) writeonly buffer Matrix { float matrix[]; };

layout(push_constant) uniform Push {
    uint dofs;
    float sigma;
} push;

void main() {
    uint row = gl_GlobalInvocationID.x;
    uint column = gl_GlobalInvocationID.y;
    if (row >= push.dofs) return;
    matrix[column * push.dofs + row] = row == column ? 1.0 : 0.0;
    if (column != 0u) return;
    float centre = centre_of(row, push.dofs);
    float spread = frame.values[push.dofs + row];
    evolution.values[row] = 0.0;
    evolution.values[push.dofs + row] = 0.0;
    for (uint side = 2u; side < 4u; side++) {
        precise float off = frame.values[side * push.dofs + row] - centre;
        precise float scaled = off * reciprocal(spread);
        evolution.values[side * push.dofs + row] = spread > 0.0 ? scaled : 0.0;
    }
    outcome.values[row] = centre;
    if (row == 0u) {
        evolution.sigma = push.sigma;
        outcome.key = 0u;
    }
}
