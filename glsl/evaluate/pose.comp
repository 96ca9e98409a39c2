#version 450
#extension GL_GOOGLE_include_directive : require

// Poses to global bone matrices (METHOD A3): one invocation a candidate, parents before children.

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

// The component of an axis. By comparing, here and below: an index that is not known when the stage is compiled costs some
// drivers a branch for every possible value, and much time to compile.
float in_order(vec3 values, uint axis) {
    return axis == 0u ? values.x : axis == 1u ? values.y : values.z;
}

void main() {
    uint candidate = gl_GlobalInvocationID.x;
    if (candidate >= batch.candidates) return;
    uint own = candidate * batch.bones;
    for (uint bone = 0u; bone < batch.bones; bone++) {
        Bone b = bones[bone];
        vec3 sine, cosine;
        for (uint axis = 0u; axis < 3u; axis++) {
            int slot = b.slots[3u + axis];
            vec2 both = slot < 0 ? vec2(0.0, 1.0) : sin_cos(pose_value(batch.first + candidate, slot));
            sine[axis] = both.x;
            cosine[axis] = both.y;
        }
        uint i = b.axes & 3u;
        uint j = (b.axes >> 2) & 3u;
        float si = b.parity * in_order(sine, i), sj = b.parity * in_order(sine, j);
        float sk = b.parity * in_order(sine, 3u - i - j);
        float ci = in_order(cosine, i), cj = in_order(cosine, j), ck = in_order(cosine, 3u - i - j);
        // Rows and columns in the order of turning, i, j, k.
        precise vec3 turned_i = vec3(cj * ck, -(cj * sk), sj);
        precise vec3 turned_j = vec3(ci * sk + si * sj * ck, ci * ck - si * sj * sk, -(si * cj));
        precise vec3 turned_k = vec3(si * sk - ci * sj * ck, si * ck + ci * sj * sk, ci * cj);
        precise float m[12];
        for (uint row = 0u; row < 3u; row++) {
            vec3 turned = row == i ? turned_i : row == j ? turned_j : turned_k;
            for (uint column = 0u; column < 3u; column++) {
                m[4u * row + column] = column == i ? turned.x : column == j ? turned.y : turned.z;
            }
            m[4u * row + 3u] = b.offset[row] + pose_value(batch.first + candidate, b.slots[row]);
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
