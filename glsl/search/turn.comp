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
layout(std430, set = 0, binding = 7) readonly buffer Matrix { float matrix[]; };
layout(std430, set = 0, binding = 8) writeonly buffer Next { float next[]; };

layout(push_constant) uniform Push {
    uint samples;
    uint dofs;
    float kept;
    float of_path;
    float of_samples;
} push;

void main() {
    uint row = gl_GlobalInvocationID.x;
    uint column = gl_GlobalInvocationID.y;
    if (row >= push.dofs) return;
    uint place = column * push.dofs + row;
    if (!is_finite(fitness[evolution.first])) {
        next[place] = matrix[place];
        return;
    }
    precise float turned = 0.0;
    for (uint d = 0u; d < push.dofs; d++) {
        precise float part = matrix[d * push.dofs + row] * evolution.values[push.dofs + d];
        turned = turned + part;
    }
    precise float sum = 0.0;
    for (uint sample_index = 0u; sample_index < push.samples; sample_index++) {
        float weight = weights[sample_index];
        if (weight == 0.0) continue;
        precise float normal = weight * normals[sample_index * push.dofs + column];
        precise float part = steps[sample_index * push.dofs + row] * normal;
        sum = sum + part;
    }
    precise float path = push.of_path * (turned * evolution.values[push.dofs + column]);
    precise float learnt = push.of_samples * sum;
    precise float entry = push.kept * matrix[place] + path + learnt;
    next[place] = entry;
}
