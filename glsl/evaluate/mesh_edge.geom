#version 450
#extension GL_GOOGLE_include_directive : require

// The silhouette edges of a triangle that shows its outside, found from its neighbours: what `outline.comp` lists and `mesh_edge.vert`
// draws, of triangles with adjacency. An edge has two triangles, of which one shows its outside, so it is drawn once.

#include "evaluate/mesh_edge.glsl"
#include "evaluate/strip.glsl"

layout(triangles_adjacency) in;
layout(triangle_strip, max_vertices = 12) out;

// Instances, and vertices of the mesh: a corner, the neighbour's third vertex across the side that begins there, the next corner.
layout(location = 0) flat in uvec2 instance_and_place[];

void main() {
    uint channel = CHANNEL;
    uint instance = instance_and_place[0].x;
    uint candidate = CANDIDATES_A_TILE * (instance / batch.views) + channel;
    if (candidate >= batch.candidates) return;
    uint image = candidate * batch.views + instance % batch.views;
    Placement placement = placements[image];
    if (placement.low == placement.high) return;
    uint from = image * batch.vertices;
    Seen corners[3];
    for (uint corner = 0u; corner < 3u; corner++) corners[corner] = seen[from + instance_and_place[2u * corner].y];
    if (!has_image(corners[0]) || !has_image(corners[1]) || !has_image(corners[2])) return;
    if (!faces_camera(corners[0].at, corners[1].at, corners[2].at)) return;
    for (uint side = 0u; side < 3u; side++) {
        uint next = (side + 1u) % 3u;
        Seen a = corners[side];
        Seen b = corners[next];
        Seen across = seen[from + instance_and_place[2u * side + 1u].y];
        if (!has_image(across) || faces_camera(b.at, a.at, across.at)) continue;
        // An edge begins at the vertex of the lower number.
        uint begin = instance_and_place[2u * side].y;
        uint end = instance_and_place[2u * next].y;
        bool turned = end < begin;
        Seen p = turned ? b : a;
        Seen q = turned ? a : b;
        Line line = line_between(p, q, placement);
        uvec3 word = written(placement, min(begin, end));
        for (uint corner = 0u; corner < 4u; corner++) {
            writes = word;
            gl_Position = corner_of(line, STRIP[corner]);
            EmitVertex();
        }
        EndPrimitive();
    }
}
