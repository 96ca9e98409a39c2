// A vertex of the mesh, posed, and as one camera sees it: as all ways of projecting it compute it (METHOD A4, A2).

#ifndef EVALUATE_POSED_VERTEX
#define EVALUATE_POSED_VERTEX

#include "evaluate/constants.glsl"
#include "evaluate/camera.glsl"
#include "evaluate/mesh.glsl"

layout(std430, set = 0, binding = 0) readonly buffer Vertices { MeshVertex vertices[]; };
layout(std430, set = 0, binding = 1) readonly buffer Skin { vec4 skin[]; };
layout(std430, set = 0, binding = 2) readonly buffer Cameras { Camera cameras[]; };

// 1 when a vertex hangs on up to four bones, 0 when on one.
layout(constant_id = 0) const uint IS_SMOOTH = 1u;

vec3 on_bone(uint candidate, uint bone, vec3 position) {
    uint rows = 3u * (candidate * batch.bones + bone);
    return transform(skin[rows], skin[rows + 1u], skin[rows + 2u], position);
}

// In the world, mm.
vec3 posed_vertex(uint candidate, uint index) {
    MeshVertex vertex = vertices[index];
    vec3 point = on_bone(candidate, vertex.bones.x, vertex.position);
    uint is_smooth = IS_SMOOTH;
    if (is_smooth == 1u) {
        vec4 w = vertex.weights;
        vec3 b = on_bone(candidate, vertex.bones.y, vertex.position);
        vec3 c = on_bone(candidate, vertex.bones.z, vertex.position);
        vec3 d = on_bone(candidate, vertex.bones.w, vertex.position);
        precise vec3 sum = ((w.x * point + w.y * b) + w.z * c) + w.w * d;
        point = sum;
    }
    return point;
}

// Snapped, with its depths.
Seen seen_from(Camera camera, vec3 point) {
    bool is_seen;
    vec3 pixel = project_point(camera, point, is_seen);
    Seen own;
    own.at = ivec2(0);
    own.depth = NO_IMAGE;
    own.edge_depth = NO_IMAGE;
    if (is_seen && pixel.z >= MESH_NEAREST) {
        own.at = ivec2(snap(pixel.x), snap(pixel.y));
        precise float depth = 1.0 - quotient(MESH_NEAR, pixel.z);
        precise float nearer = pixel.z - MESH_EDGE_BIAS;
        precise float edge_depth = 1.0 - quotient(MESH_NEAR, nearer);
        own.depth = depth;
        own.edge_depth = edge_depth;
    }
    return own;
}

#endif
