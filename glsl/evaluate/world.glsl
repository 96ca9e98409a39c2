// Bone matrices as a pass before has left them: three rows a bone.

#ifndef EVALUATE_WORLD
#define EVALUATE_WORLD

#include "evaluate/batch.glsl"

layout(std430, set = 0, binding = 2) readonly buffer World { vec4 world[]; };

vec4 row_of_bone(uint candidate, uint bone, uint row) {
    return world[3u * (candidate * batch.bones + bone) + row];
}

#endif
