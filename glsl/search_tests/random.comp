#version 450
#extension GL_GOOGLE_include_directive : require

// Blocks of random words and of normal numbers by their counters, to test the generator alone.

#include "search/constants.glsl"
#include "search/philox.glsl"

layout(local_size_x = SEARCH_GROUP) in;

layout(std430, set = 0, binding = 0) readonly buffer Counters { uvec4 counters[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Words { uvec4 words[]; };
layout(std430, set = 0, binding = 2) writeonly buffer Normals { vec4 normals[]; };

layout(push_constant) uniform Push {
    uint count;
    uint key_low;
    uint key_high;
} push;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) return;
    uvec4 block = philox(counters[i], uvec2(push.key_low, push.key_high));
    words[i] = block;
    normals[i] = normals_of(block);
}
