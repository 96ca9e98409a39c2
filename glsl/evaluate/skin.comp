#version 450
#extension GL_GOOGLE_include_directive : require

// Every vertex of every candidate, posed once and projected into every camera once (METHOD A4, A2): snapped, with its depths; and
// the pixels that each image may touch. Workgroups in x take vertices, in y candidates.

#include "evaluate/constants.glsl"
#include "evaluate/camera.glsl"
#include "evaluate/mesh.glsl"

layout(local_size_x = MESH_GROUP) in;

layout(std430, set = 0, binding = 0) readonly buffer Vertices { MeshVertex vertices[]; };
layout(std430, set = 0, binding = 1) readonly buffer Skin { vec4 skin[]; };
layout(std430, set = 0, binding = 2) readonly buffer Cameras { Camera cameras[]; };
// [candidate][view][vertex]
layout(std430, set = 0, binding = 3) writeonly buffer AllSeen { Seen seen[]; };
// Low x, low y, high x, high y an image.
layout(std430, set = 0, binding = 4) buffer AllBounds { int bounds[]; };

// 1 when a vertex hangs on up to four bones, 0 when on one.
layout(constant_id = 0) const uint IS_SMOOTH = 1u;

// Low x, low y, -high x, -high y of the workgroup's part of an image.
shared int touched[4];

const int NOTHING = 0x7fffffff;

vec3 on_bone(uint bone, vec3 position) {
    uint rows = 3u * (gl_WorkGroupID.y * batch.bones + bone);
    return transform(skin[rows], skin[rows + 1u], skin[rows + 2u], position);
}

void main() {
    uint candidate = gl_WorkGroupID.y;
    uint index = gl_GlobalInvocationID.x;
    bool is_active = index < batch.vertices;
    vec3 point = vec3(0.0);
    if (is_active) {
        MeshVertex vertex = vertices[index];
        point = on_bone(vertex.bones.x, vertex.position);
        uint is_smooth = IS_SMOOTH;
        if (is_smooth == 1u) {
            vec4 w = vertex.weights;
            vec3 b = on_bone(vertex.bones.y, vertex.position);
            vec3 c = on_bone(vertex.bones.z, vertex.position);
            vec3 d = on_bone(vertex.bones.w, vertex.position);
            precise vec3 sum = ((w.x * point + w.y * b) + w.z * c) + w.w * d;
            point = sum;
        }
    }
    uint unit = gl_LocalInvocationID.x;
    if (unit < 4u) touched[unit] = NOTHING;
    for (uint view = 0u; view < batch.views; view++) {
        barrier();
        uint image = candidate * batch.views + view;
        if (is_active) {
            bool is_seen;
            vec3 pixel = project_point(cameras[view], point, is_seen);
            is_seen = is_seen && pixel.z >= MESH_NEAREST;
            Seen own;
            own.at = ivec2(0);
            own.depth = NO_IMAGE;
            own.edge_depth = NO_IMAGE;
            if (is_seen) {
                own.at = ivec2(snap(pixel.x), snap(pixel.y));
                precise float depth = 1.0 - quotient(MESH_NEAR, pixel.z);
                precise float nearer = pixel.z - MESH_EDGE_BIAS;
                precise float edge_depth = 1.0 - quotient(MESH_NEAR, nearer);
                own.depth = depth;
                own.edge_depth = edge_depth;
                // Triangles and outlines stay within the vertices rounded to pixels.
                ivec2 size = ivec2(cameras[view].size);
                ivec2 rounded = (own.at + 128) >> 8;
                ivec2 low = clamp(rounded, ivec2(0), size);
                ivec2 high = clamp(rounded + 1, ivec2(0), size);
                atomicMin(touched[0], low.x);
                atomicMin(touched[1], low.y);
                atomicMin(touched[2], -high.x);
                atomicMin(touched[3], -high.y);
            }
            seen[image * batch.vertices + index] = own;
        }
        barrier();
        if (unit < 4u) {
            int most = touched[unit];
            touched[unit] = NOTHING;
            if (most != NOTHING) {
                if (unit < 2u) {
                    atomicMin(bounds[4u * image + unit], most);
                } else {
                    atomicMax(bounds[4u * image + unit], -most);
                }
            }
        }
    }
}
