#version 450
#extension GL_GOOGLE_include_directive : require

// Takes pixels that do not count out of the silhouette and the edges: a word of each an invocation.

#include "features/constants.glsl"
#include "features/place.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Ignored { uint ignored[]; };
layout(std430, set = 0, binding = 1) buffer Silhouette { uint silhouette[]; };
layout(std430, set = 0, binding = 2) buffer Edges { uint edges[]; };

layout(push_constant) uniform Ignore {
    uint words;
} push;

void main() {
    uint place = flat_place();
    if (place >= push.words) return;
    uint kept = ~ignored[place];
    silhouette[place] &= kept;
    edges[place] &= kept;
}
