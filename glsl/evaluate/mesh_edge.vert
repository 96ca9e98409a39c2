#version 450
#extension GL_GOOGLE_include_directive : require

// A silhouette edge as the pixels of the border line of docs/RASTER.md: the devices' own lines differ, so it is a parallelogram
// as high as a pixel along the line's longer axis, from half a pixel before its first to half a pixel behind its last pixel.
// Two triangles an edge.

#include "evaluate/draw_mesh.glsl"
#include "arithmetic/rounding.glsl"

layout(std430, set = 0, binding = 4) readonly buffer Edges { MeshEdge edges[]; };
layout(std430, set = 0, binding = 5) readonly buffer Outlines { uint outlines[]; };

layout(location = 0) flat out uvec3 writes;

// Pixel centres on the upper side are inside, so a tie goes to the larger coordinate when the whole lies a little lower.
const float LOWER = 1.0 / 256.0;

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
    ivec2 from = ((p.at + 128) >> 8) + placement.shift;
    ivec2 to = ((q.at + 128) >> 8) + placement.shift;
    ivec2 d = to - from;
    bool along_x = abs(d.x) >= abs(d.y);
    // From left to right, or from the top down.
    bool turned = along_x ? d.x < 0 : d.y < 0;
    ivec2 start = turned ? to : from;
    ivec2 way = turned ? -d : d;
    float steps = float(along_x ? way.x : way.y);
    float rise = steps == 0.0 ? 0.0 : quotient(float(along_x ? way.y : way.x), steps);
    float near = turned ? q.edge_depth : p.edge_depth;
    float far = turned ? p.edge_depth : q.edge_depth;
    float slope = steps == 0.0 ? 0.0 : quotient(far - near, steps);
    bool at_end = corner == 1u || corner == 2u || corner == 4u;
    bool lower = corner == 2u || corner == 4u || corner == 5u;
    float along = at_end ? steps + 0.5 : -0.5;
    float across = rise * along + (lower ? 0.5 : -0.5) + LOWER;
    vec2 pixel = vec2(start) + (along_x ? vec2(along, across) : vec2(across, along));
    writes = uvec3(placement.low, placement.high, (vertices[edge.ends.x].label | 0x80u) * 0x01010101u);
    gl_Position = to_clip_space(pixel, near + slope * along);
}
