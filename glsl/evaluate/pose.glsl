// A bone of a pose, as all ways of posing compute it (METHOD A3).

#ifndef EVALUATE_POSE
#define EVALUATE_POSE

#include "evaluate/model.glsl"
#include "evaluate/batch.glsl"
#include "evaluate/arithmetic.glsl"

layout(std430, set = 0, binding = 5) readonly buffer Bones { Bone bones[]; };
layout(std430, set = 0, binding = 6) readonly buffer Poses { float poses[]; };

// Rows of an affine matrix.
struct Rows {
    vec4 row[3];
};

// `candidate` in the whole run.
float pose_value(uint candidate, int slot) {
    return slot < 0 ? 0.0 : poses[candidate * batch.dofs + uint(slot)];
}

// The component of an axis. By comparing, here and below: an index that is not known when the stage is compiled costs some
// drivers a branch for every possible value, and much time to compile.
float in_order(vec3 values, uint axis) {
    return axis == 0u ? values.x : axis == 1u ? values.y : values.z;
}

// A bone in its parent's frame.
Rows bone_in_parent(Bone b, uint candidate) {
    vec3 sine, cosine;
    for (uint axis = 0u; axis < 3u; axis++) {
        int slot = b.slots[3u + axis];
        vec2 both = slot < 0 ? vec2(0.0, 1.0) : sin_cos(pose_value(candidate, slot));
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
    Rows local;
    for (uint row = 0u; row < 3u; row++) {
        vec3 turned = row == i ? turned_i : row == j ? turned_j : turned_k;
        for (uint column = 0u; column < 3u; column++) {
            local.row[row][column] = column == i ? turned.x : column == j ? turned.y : turned.z;
        }
        precise float moved = b.offset[row] + pose_value(candidate, b.slots[row]);
        local.row[row].w = moved;
    }
    return local;
}

// A row of a bone in the world, from that row of its parent.
vec4 row_in_world(vec4 p, Rows local) {
    vec4 a = local.row[0], b = local.row[1], c = local.row[2];
    precise vec4 placed;
    placed.x = (p.x * a.x + p.y * b.x) + p.z * c.x;
    placed.y = (p.x * a.y + p.y * b.y) + p.z * c.y;
    placed.z = (p.x * a.z + p.y * b.z) + p.z * c.z;
    placed.w = ((p.x * a.w + p.y * b.w) + p.z * c.w) + p.w;
    return placed;
}

#endif
