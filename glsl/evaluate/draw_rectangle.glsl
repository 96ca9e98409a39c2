// A part as one rectangle that surely covers its fill and its border, with what the fragment stage decides each pixel by
// (docs/RASTER.md): what the vertex stage and the geometry stage share.

#ifndef EVALUATE_DRAW_RECTANGLE
#define EVALUATE_DRAW_RECTANGLE

#include "evaluate/constants.glsl"
#include "evaluate/draw.glsl"

// All in pixels from the left top of what the image may touch.
// An edge each, from its upper to its lower end: dx and dy, 1/256 pixel; z: a pixel is at or right of it when dy x - dx y >= z; and
// the rows that it crosses, from | to << 16.
layout(location = 0) flat out ivec4 edge0;
layout(location = 1) flat out ivec4 edge1;
layout(location = 2) flat out ivec4 edge2;
layout(location = 3) flat out ivec4 edge3;
// A border line each: dx and dy, signed so that a pixel lies on the line when -m <= 2 (dy x - dx y + z) < m, with m the larger
// of |dx| and |dy|; z; and the range along the longer axis, from | to << 16.
layout(location = 4) flat out ivec4 line0;
layout(location = 5) flat out ivec4 line1;
layout(location = 6) flat out ivec4 line2;
layout(location = 7) flat out ivec4 line3;
// What may be touched (left | top << 16, width | height << 16), the word of a fill, what an edge adds.
layout(location = 8) flat out uvec4 writes;

// Pixels that a border pixel's centre may lie outside of the corners' hull, with room for the device's rounding.
const float MARGIN = 1.75;

// The smallest whole number at or above (x dy - y dx) / 256, as far as 32 bits go: `place.comp` sees to it that what is compared
// with it does not go beyond.
int least_at_or_right(ivec2 p, ivec2 d) {
    int high_x, low_x, high_y, low_y;
    imulExtended(p.x, d.y, high_x, low_x);
    imulExtended(p.y, d.x, high_y, low_y);
    uint low = uint(low_x) - uint(low_y);
    int high = high_x - high_y - (uint(low_x) < uint(low_y) ? 1 : 0);
    uint raised = low + 255u;
    high += raised < low ? 1 : 0;
    if (high > 127) return 0x7fffffff;
    if (high < -128) return int(0x80000000u);
    return int((raised >> 8) | (uint(high) << 24));
}

ivec4 fill_edge(ivec2 p, ivec2 q, ivec2 size) {
    ivec2 upper = p.y <= q.y ? p : q;
    ivec2 lower = p.y <= q.y ? q : p;
    ivec2 d = lower - upper;
    // The rows whose centres lie at or below the upper end and above the lower one.
    int from = clamp((upper.y + 255) >> 8, 0, size.y);
    int to = clamp((lower.y + 255) >> 8, 0, size.y);
    return ivec4(d, least_at_or_right(upper, d), from | to << 16);
}

ivec4 border_line(ivec2 p, ivec2 q, ivec2 size) {
    ivec2 d = q - p;
    bool along_x = abs(d.x) >= abs(d.y);
    int turn = along_x ? sign(d.x) : -sign(d.y);
    ivec2 turned = turn * d;
    // A point is a line of no length along x: its own row, and its own column by the range.
    if (d == ivec2(0)) turned = ivec2(1, 0);
    // The range as far as it may be touched, so that it fits 16 bits.
    int most = along_x ? size.x : size.y;
    int from = clamp(along_x ? min(p.x, q.x) : min(p.y, q.y), 0, most);
    int to = clamp((along_x ? max(p.x, q.x) : max(p.y, q.y)) + 1, 0, most);
    return ivec4(turned, turned.x * p.y - turned.y * p.x, from | to << 16);
}

struct Rectangle {
    vec2 origin; // a corner of the part; pixels, from the left top of what may be touched, as all here
    vec2 along;
    vec2 across;
    vec2 ends;  // least and most along
    vec2 sides; // least and most across
    vec4 upright; // left, top, right, bottom
    bool leaves;  // whether that takes its place
    ivec2 low;
    float depth;
};

// The rectangle of a part that is drawn; what is told of it goes to the outputs.
Rectangle rectangle_of(Placed part) {
    uint at = part.image * batch.parts + part.place;
    ivec2 low = unpack_place(part.placement.low);
    ivec2 size = unpack_place(part.placement.high) - low;
    ivec4 x = quads[at].x + 256 * (part.placement.shift.x - low.x);
    ivec4 y = quads[at].y + 256 * (part.placement.shift.y - low.y);
    edge0 = fill_edge(ivec2(x.x, y.x), ivec2(x.y, y.y), size);
    edge1 = fill_edge(ivec2(x.y, y.y), ivec2(x.z, y.z), size);
    edge2 = fill_edge(ivec2(x.z, y.z), ivec2(x.w, y.w), size);
    edge3 = fill_edge(ivec2(x.w, y.w), ivec2(x.x, y.x), size);
    ivec4 px = (x + 128) >> 8;
    ivec4 py = (y + 128) >> 8;
    line0 = border_line(ivec2(px.x, py.x), ivec2(px.y, py.y), size);
    line1 = border_line(ivec2(px.y, py.y), ivec2(px.z, py.z), size);
    line2 = border_line(ivec2(px.z, py.z), ivec2(px.w, py.w), size);
    line3 = border_line(ivec2(px.w, py.w), ivec2(px.x, py.x), size);
    writes = uvec4(part.placement.low, uint(size.x) | uint(size.y) << 16, part.base, part.edge);

    // All that may be written lies between these.
    ivec2 least = ivec2(min(min(px.x, px.y), min(px.z, px.w)), min(min(py.x, py.y), min(py.z, py.w)));
    ivec2 most = ivec2(max(max(px.x, px.y), max(px.z, px.w)), max(max(py.x, py.y), max(py.z, py.w)));

    // The rectangle along the part, or, where that leaves what may be touched, the upright one cut to it.
    vec2 c0 = vec2(x.x, y.x) / 256.0;
    vec2 c1 = vec2(x.y, y.y) / 256.0;
    vec2 c2 = vec2(x.z, y.z) / 256.0;
    vec2 c3 = vec2(x.w, y.w) / 256.0;
    vec2 along = (c1 - c0) + (c2 - c3);
    float length_along = length(along);
    along = length_along > 1e-2 ? along / length_along : vec2(1.0, 0.0);
    vec2 across = vec2(-along.y, along.x);
    vec4 a = vec4(0.0, dot(c1 - c0, along), dot(c2 - c0, along), dot(c3 - c0, along));
    vec4 b = vec4(0.0, dot(c1 - c0, across), dot(c2 - c0, across), dot(c3 - c0, across));
    Rectangle rectangle;
    rectangle.origin = c0;
    rectangle.along = along;
    rectangle.across = across;
    rectangle.ends = vec2(min(min(a.x, a.y), min(a.z, a.w)) - MARGIN, max(max(a.x, a.y), max(a.z, a.w)) + MARGIN);
    rectangle.sides = vec2(min(min(b.x, b.y), min(b.z, b.w)) - MARGIN, max(max(b.x, b.y), max(b.z, b.w)) + MARGIN);
    rectangle.leaves = any(lessThan(least - 1, ivec2(0))) || any(greaterThan(most + 1, size));
    vec2 from = vec2(max(least - 1, 0)) - 0.75;
    rectangle.upright = vec4(from, max(vec2(min(most + 2, size)) - 0.25, from));
    rectangle.low = low;
    rectangle.depth = part.depth;
    return rectangle;
}

// In clip space; 0 to 3 go round it.
vec4 corner_of(Rectangle rectangle, uint corner) {
    bool is_far = (corner & 2u) != 0u;
    bool is_right = corner == 1u || corner == 2u;
    float end = is_far ? rectangle.ends.y : rectangle.ends.x;
    float side = is_right ? rectangle.sides.y : rectangle.sides.x;
    vec2 pixel = rectangle.origin + end * rectangle.along + side * rectangle.across;
    vec4 upright = rectangle.upright;
    if (rectangle.leaves) pixel = vec2(is_right ? upright.z : upright.x, is_far ? upright.w : upright.y);
    return to_clip_space(pixel + vec2(rectangle.low), rectangle.depth);
}

#endif
