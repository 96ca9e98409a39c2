#version 450
#extension GL_GOOGLE_include_directive : require

// The pixels that each image of the mesh may touch, from its vertices as they are seen: what follows transform feedback. Workgroups in x
// take vertices, in y images.

#include "evaluate/constants.glsl"
#include "evaluate/model.glsl"
#include "evaluate/mesh_bounds.glsl"

layout(local_size_x = MESH_GROUP) in;

layout(std430, set = 0, binding = 0) readonly buffer AllSeen { Seen seen[]; };
layout(std430, set = 0, binding = 1) readonly buffer Cameras { Camera cameras[]; };

void main() {
    uint image = gl_WorkGroupID.y;
    uint index = gl_GlobalInvocationID.x;
    bool is_seen = false;
    ivec2 at = ivec2(0);
    if (index < batch.vertices) {
        Seen own = seen[image * batch.vertices + index];
        is_seen = has_image(own);
        at = own.at;
    }
    touch_nothing();
    touch(image, ivec2(cameras[image % batch.views].size), is_seen, at);
}
