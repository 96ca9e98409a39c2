#version 450
#extension GL_GOOGLE_include_directive : require

// A silhouette edge of those that a compute stage has listed. Two triangles an edge.

#include "evaluate/mesh_edge.glsl"

layout(std430, set = 0, binding = 4) readonly buffer Edges { MeshEdge edges[]; };
layout(std430, set = 0, binding = 5) readonly buffer Outlines { uint outlines[]; };

// The corners of the triangles.
const uint CORNERS[OUTLINE_VERTICES] = uint[OUTLINE_VERTICES](0u, 1u, 2u, 0u, 2u, 3u);

void main() {
    uint channel = CHANNEL;
    uint place = uint(gl_VertexIndex) / OUTLINE_VERTICES;
    uint corner = uint(gl_VertexIndex) % OUTLINE_VERTICES;
    uint outline = outlines[channel * batch.most_outlines + place];
    uint image = outline / batch.edges;
    MeshEdge edge = edges[outline % batch.edges];
    Placement placement = placements[image];
    Seen p = seen[image * batch.vertices + edge.ends.x];
    Seen q = seen[image * batch.vertices + edge.ends.y];
    writes = written(placement, edge.ends.x);
    gl_Position = corner_of(line_between(p, q, placement), CORNERS[corner]);
}
