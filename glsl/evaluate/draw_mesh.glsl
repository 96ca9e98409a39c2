// What drawing the mesh's triangles and its silhouette edges shares.

#ifndef EVALUATE_DRAW_MESH
#define EVALUATE_DRAW_MESH

#include "evaluate/constants.glsl"
#include "evaluate/tiles.glsl"
#include "evaluate/mesh.glsl"

layout(std430, set = 0, binding = 0) readonly buffer Vertices { MeshVertex vertices[]; };
layout(std430, set = 0, binding = 1) readonly buffer AllSeen { Seen seen[]; };
layout(std430, set = 0, binding = 2) readonly buffer Placements { Placement placements[]; };
layout(std430, set = 0, binding = 3) readonly buffer Tiles {
    vec2 to_clip;
    ViewTiles tiles[];
};

layout(constant_id = 1) const uint CHANNEL = 0u;

// Pixel coordinates of the framebuffer, whole numbers at pixel centres, to clip space. Depths from 1/2 on fill the channel's
// quarter of the range: a later channel is nearer than all of an earlier one. The few edges nearer than that are as near as
// anything.
vec4 to_clip_space(vec2 pixel, float depth) {
    uint channel = CHANNEL;
    float own = clamp(2.0 * depth - 1.0, 0.0, 1.0);
    return vec4((pixel + 0.5) * to_clip - 1.0, (float(3u - channel) + own) * 0.25, 1.0);
}

#endif
