#version 450
#extension GL_GOOGLE_include_directive : require

// Poses to global bone matrices (METHOD A3): one invocation a candidate, parents before children.

#include "evaluate/pose.glsl"

layout(local_size_x = 64) in;

// Three rows a bone: world[3 * (candidate * bones + bone) + row].
layout(std430, set = 0, binding = 2) buffer World { vec4 world[]; };

void main() {
    uint candidate = gl_GlobalInvocationID.x;
    if (candidate >= batch.candidates) return;
    uint own = candidate * batch.bones;
    for (uint bone = 0u; bone < batch.bones; bone++) {
        Bone b = bones[bone];
        Rows local = bone_in_parent(b, batch.first + candidate);
        for (uint row = 0u; row < 3u; row++) {
            vec4 placed = local.row[row];
            if (b.parent >= 0) placed = row_in_world(world[3u * (own + uint(b.parent)) + row], local);
            world[3u * (own + bone) + row] = placed;
        }
    }
}
