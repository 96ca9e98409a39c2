#version 450
#extension GL_GOOGLE_include_directive : require

// The matrix learns from the path and from the better half of the samples. One invocation an entry.

#include "search/constants.glsl"
#include "search/frame.glsl"
#include "search/evolution.glsl"

layout(local_size_x = SEARCH_GROUP) in;

layout(std430, set = 0, binding = 3) readonly buffer Fitness { float fitness[]; };
layout(std430, set = 0, binding = 4) readonly buffer Weights { float weights[]; };
layout(std430, set = 0, binding = 5) readonly buffer Normals { float normals[]; };
layout(std430, set = 0, binding = 6) readonly buffer Steps { float steps[]; };
layout(std430, set = 0, binding = 8) writeonly buffer Next { float next[]; };

layout(push_constant) uniform Push {
    uint samples;
    uint dofs;
    float kept;
    float of_path;
    float of_samples;
} push;

#define PATH(d) evolution.values[push.dofs + (d)]
#include "search/turning.glsl"

void main() {
    uint row = gl_GlobalInvocationID.x;
    uint column = gl_GlobalInvocationID.y;
    if (row >= push.dofs) return;
    uint place = column * push.dofs + row;
    if (!is_finite(fitness[evolution.first])) {
        next[place] = matrix[place];
        return;
    }
    next[place] = entry_after(row, column, push.samples);
}
