// A silhouette edge as the pixels of the border line of docs/RASTER.md: the devices' own lines differ, so it is a parallelogram
// as high as a pixel along the line's longer axis, from half a pixel before its first to half a pixel behind its last pixel.

#ifndef EVALUATE_MESH_EDGE
#define EVALUATE_MESH_EDGE

#include "evaluate/draw_mesh.glsl"
#include "arithmetic/rounding.glsl"

layout(location = 0) flat out uvec3 writes;

// Pixel centres on the upper side are inside, so a tie goes to the larger coordinate when the whole lies a little lower.
const float LOWER = 1.0 / 256.0;

struct Line {
    vec2 start; // framebuffer pixels, the left or upper end
    bool along_x;
    float steps;
    float rise;
    float near; // depth at the start
    float slope;
};

// From p to q.
Line line_between(Seen p, Seen q, Placement placement) {
    ivec2 from = ((p.at + 128) >> 8) + placement.shift;
    ivec2 to = ((q.at + 128) >> 8) + placement.shift;
    ivec2 d = to - from;
    Line line;
    line.along_x = abs(d.x) >= abs(d.y);
    // From left to right, or from the top down.
    bool turned = line.along_x ? d.x < 0 : d.y < 0;
    line.start = vec2(turned ? to : from);
    ivec2 way = turned ? -d : d;
    line.steps = float(line.along_x ? way.x : way.y);
    line.rise = line.steps == 0.0 ? 0.0 : quotient(float(line.along_x ? way.y : way.x), line.steps);
    line.near = turned ? q.edge_depth : p.edge_depth;
    float far = turned ? p.edge_depth : q.edge_depth;
    line.slope = line.steps == 0.0 ? 0.0 : quotient(far - line.near, line.steps);
    return line;
}

// In clip space; 0 to 3 go round it.
vec4 corner_of(Line line, uint corner) {
    bool at_end = corner == 1u || corner == 2u;
    bool lower = corner >= 2u;
    float along = at_end ? line.steps + 0.5 : -0.5;
    float across = line.rise * along + (lower ? 0.5 : -0.5) + LOWER;
    vec2 pixel = line.start + (line.along_x ? vec2(along, across) : vec2(across, along));
    return to_clip_space(pixel, line.near + line.slope * along);
}

// What may be touched, and the word; `first` is the edge's first end, whose label it has.
uvec3 written(Placement placement, uint first) {
    return uvec3(placement.low, placement.high, (vertices[first].label | 0x80u) * 0x01010101u);
}

#endif
