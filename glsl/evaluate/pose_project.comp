#version 450
#extension GL_GOOGLE_include_directive : require

// `pose.comp` and `project.comp` in one: a workgroup poses the candidates of its images, in shared memory, and projects their parts.

#include "evaluate/order.glsl"
#include "evaluate/pose.glsl"

layout(local_size_x = PROJECT_GROUP, local_size_x_id = 1) in;

// Rows of the bones of the workgroup's candidates: three for each bone of the most candidates that its images can be of.
layout(constant_id = 0) const uint posed_rows = 96u;
shared vec4 rows_here[posed_rows];

// The first of them.
uint first_here() {
    return gl_WorkGroupID.x * (gl_WorkGroupSize.x / batch.parts) / batch.views;
}

vec4 row_of_bone(uint candidate, uint bone, uint row) {
    return rows_here[3u * ((candidate - first_here()) * batch.bones + bone) + row];
}

#include "evaluate/project_part.glsl"

void main() {
    uint images = batch.candidates * batch.views;
    uint end = min((gl_WorkGroupID.x + 1u) * (gl_WorkGroupSize.x / batch.parts), images);
    uint first = first_here();
    uint count = (end + batch.views - 1u) / batch.views - first;
    // Every bone in its parent, an invocation each.
    for (uint at = gl_LocalInvocationID.x; at < count * batch.bones; at += gl_WorkGroupSize.x) {
        Rows local = bone_in_parent(bones[at % batch.bones], batch.first + first + at / batch.bones);
        for (uint row = 0u; row < 3u; row++) rows_here[3u * at + row] = local.row[row];
    }
    barrier();
    // Then in the world, parents before children, a candidate each.
    for (uint own = gl_LocalInvocationID.x; own < count; own += gl_WorkGroupSize.x) {
        for (uint bone = 0u; bone < batch.bones; bone++) {
            int parent = bones[bone].parent;
            if (parent < 0) continue;
            uint place = 3u * (own * batch.bones + bone);
            uint before = 3u * (own * batch.bones + uint(parent));
            Rows local;
            for (uint row = 0u; row < 3u; row++) local.row[row] = rows_here[place + row];
            for (uint row = 0u; row < 3u; row++) rows_here[place + row] = row_in_world(rows_here[before + row], local);
        }
    }
    barrier();
    Own own = own_part(gl_WorkGroupSize.x);
    Quad quad;
    if (own.is_active) quad = project_part(own.image, own.part);
    write_in_order(own, quad, cameras[own.image % batch.views].size);
}
