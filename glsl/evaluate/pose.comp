#version 450
#extension GL_GOOGLE_include_directive : require

// Poses to global bone matrices (SPEC A3): one invocation a candidate, parents before children.

#include "evaluate/model.glsl"
#include "evaluate/batch.glsl"
#include "evaluate/arithmetic.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Bones { Bone bones[]; };
layout(std430, set = 0, binding = 1) readonly buffer Poses { float poses[]; };
// Three rows a bone: world[3 * (candidate * bones + bone) + row].
layout(std430, set = 0, binding = 2) buffer World { vec4 world[]; };

float pose_value(uint candidate, int slot) {
    return slot < 0 ? 0.0 : poses[candidate * batch.dofs + uint(slot)];
}

void main() {
    uint candidate = gl_GlobalInvocationID.x;
    if (candidate >= batch.candidates) return;
    uint own = candidate * batch.bones;
    for (uint bone = 0u; bone < batch.bones; bone++) {
        Bone b = bones[bone];
        precise float m[12];
        float sine[3];
        float cosine[3];
        for (uint axis = 0u; axis < 3u; axis++) {
            int slot = b.slots[3u + axis];
            vec2 both = slot < 0 ? vec2(0.0, 1.0) : sin_cos(pose_value(batch.first + candidate, slot));
            sine[axis] = both.x;
            cosine[axis] = both.y;
        }
        uint i = b.axes & 3u;
        uint j = (b.axes >> 2) & 3u;
        uint k = (b.axes >> 4) & 3u;
        float si = b.parity * sine[i], sj = b.parity * sine[j], sk = b.parity * sine[k];
        float ci = cosine[i], cj = cosine[j], ck = cosine[k];
        m[4u * i + i] = cj * ck;
        m[4u * i + j] = -(cj * sk);
        m[4u * i + k] = sj;
        m[4u * j + i] = ci * sk + si * sj * ck;
        m[4u * j + j] = ci * ck - si * sj * sk;
        m[4u * j + k] = -(si * cj);
        m[4u * k + i] = si * sk - ci * sj * ck;
        m[4u * k + j] = si * ck + ci * sj * sk;
        m[4u * k + k] = ci * cj;
        for (uint axis = 0u; axis < 3u; axis++) {
            m[4u * axis + 3u] = b.offset[axis] + pose_value(batch.first + candidate, b.slots[axis]);
        }
        for (uint row = 0u; row < 3u; row++) {
            precise vec4 placed;
            if (b.parent < 0) {
                placed = vec4(m[4u * row], m[4u * row + 1u], m[4u * row + 2u], m[4u * row + 3u]);
            } else {
                vec4 p = world[3u * (own + uint(b.parent)) + row];
                placed.x = (p.x * m[0] + p.y * m[4]) + p.z * m[8];
                placed.y = (p.x * m[1] + p.y * m[5]) + p.z * m[9];
                placed.z = (p.x * m[2] + p.y * m[6]) + p.z * m[10];
                placed.w = ((p.x * m[3] + p.y * m[7]) + p.z * m[11]) + p.w;
            }
            world[3u * (own + bone) + row] = placed;
        }
    }
}
