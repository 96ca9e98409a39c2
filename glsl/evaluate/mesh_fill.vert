#version 450
#extension GL_GOOGLE_include_directive : require

// A vertex of the mesh's triangles in its tile, an instance an image of one channel.

#include "evaluate/draw_mesh.glsl"

// What may be touched, and the word; of a triangle's first vertex.
layout(location = 0) flat out uvec3 writes;

void main() {
    uint channel = CHANNEL;
    uint index = uint(gl_VertexIndex);
    uint view = uint(gl_InstanceIndex) % batch.views;
    uint candidate = CANDIDATES_A_TILE * (uint(gl_InstanceIndex) / batch.views) + channel;
    // Beyond the far plane by so much that of a triangle with this corner nothing wider than a 1/256 of a pixel is left.
    gl_Position = vec4(0.0, 0.0, 1e15, 1.0);
    writes = uvec3(0u);
    if (candidate >= batch.candidates) return;
    uint image = candidate * batch.views + view;
    Placement placement = placements[image];
    Seen own = seen[image * batch.vertices + index];
    if (placement.low == placement.high || !has_image(own)) return;
    writes = uvec3(placement.low, placement.high, vertices[index].label * 0x01010101u);
    gl_Position = to_clip_space(vec2(own.at + 256 * placement.shift) * (1.0 / 256.0), own.depth);
}
