#version 450
#extension GL_GOOGLE_include_directive : require

// Adds to a silhouette what its closing adds, where the picture differs faintly from the plate.

#include "features/constants.glsl"
#include "features/place.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Before { uint before[]; };
layout(std430, set = 0, binding = 1) readonly buffer Closed { uint closed[]; };
layout(std430, set = 0, binding = 2) readonly buffer Faint { uint faint[]; };
layout(std430, set = 0, binding = 3) writeonly buffer After { uint after[]; };

layout(push_constant) uniform Bridge {
    uint words;
} push;

void main() {
    uint place = flat_place();
    if (place >= push.words) return;
    after[place] = before[place] | (closed[place] & faint[place]);
}
