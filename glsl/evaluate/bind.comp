#version 450
#extension GL_GOOGLE_include_directive : require

// Bone matrices times inverse bind matrices (METHOD A4), one invocation a bone of a candidate; and an empty start for what the next
// stage gathers, the bounds of images.

#include "evaluate/constants.glsl"
#include "evaluate/model.glsl"
#include "evaluate/mesh.glsl"

layout(local_size_x = MESH_GROUP) in;

layout(std430, set = 0, binding = 0) readonly buffer World { vec4 world[]; };
layout(std430, set = 0, binding = 1) readonly buffer InverseBind { vec4 inverse_bind[]; };
layout(std430, set = 0, binding = 2) readonly buffer Cameras { Camera cameras[]; };
// Three rows a bone, as `world`.
layout(std430, set = 0, binding = 3) writeonly buffer Skin { vec4 skin[]; };
layout(std430, set = 0, binding = 4) writeonly buffer AllBounds { Bounds bounds[]; };

vec4 compose_row(vec4 p, vec4 l0, vec4 l1, vec4 l2) {
    precise vec4 sum = (p.x * l0 + p.y * l1) + p.z * l2;
    precise float last = sum.w + p.w;
    return vec4(sum.xyz, last);
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index < batch.candidates * batch.views) {
        Bounds none;
        none.low = ivec2(cameras[index % batch.views].size);
        none.high = ivec2(0);
        bounds[index] = none;
    }
    if (index >= batch.candidates * batch.bones) return;
    uint local = 3u * (index % batch.bones);
    vec4 l0 = inverse_bind[local], l1 = inverse_bind[local + 1u], l2 = inverse_bind[local + 2u];
    for (uint row = 0u; row < 3u; row++) {
        skin[3u * index + row] = compose_row(world[3u * index + row], l0, l1, l2);
    }
}
