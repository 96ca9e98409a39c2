#version 450
#extension GL_GOOGLE_include_directive : require

// Every vertex of every candidate, posed once and projected into every camera once (METHOD A4, A2): snapped, with its depths; and
// the pixels that each image may touch. Workgroups in x take vertices, in y candidates.

#include "evaluate/posed_vertex.glsl"
#include "evaluate/mesh_bounds.glsl"

layout(local_size_x = MESH_GROUP) in;

// [candidate][view][vertex]
layout(std430, set = 0, binding = 3) writeonly buffer AllSeen { Seen seen[]; };

void main() {
    uint candidate = gl_WorkGroupID.y;
    uint index = gl_GlobalInvocationID.x;
    bool is_active = index < batch.vertices;
    vec3 point = vec3(0.0);
    if (is_active) point = posed_vertex(candidate, index);
    touch_nothing();
    for (uint view = 0u; view < batch.views; view++) {
        uint image = candidate * batch.views + view;
        bool is_seen = false;
        ivec2 at = ivec2(0);
        if (is_active) {
            Seen own = seen_from(cameras[view], point);
            seen[image * batch.vertices + index] = own;
            is_seen = has_image(own);
            at = own.at;
        }
        touch(image, ivec2(cameras[view].size), is_seen, at);
    }
}
