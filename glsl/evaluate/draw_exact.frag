#version 450
#extension GL_GOOGLE_include_directive : require

// One pixel of one part by the exact rule of docs/RASTER.md, in integers: the same on every device, whatever its rasteriser.

#include "evaluate/constants.glsl"

layout(location = 0) flat in ivec4 edge0;
layout(location = 1) flat in ivec4 edge1;
layout(location = 2) flat in ivec4 edge2;
layout(location = 3) flat in ivec4 edge3;
layout(location = 4) flat in ivec4 line0;
layout(location = 5) flat in ivec4 line1;
layout(location = 6) flat in ivec4 line2;
layout(location = 7) flat in ivec4 line3;
layout(location = 8) flat in uvec4 writes;

layout(location = 0) out vec4 colour;

layout(constant_id = 0) const uint PACKING = 0u;

bool crosses(ivec4 edge, ivec2 pixel) {
    return pixel.y >= (edge.w & 0xffff) && pixel.y < edge.w >> 16;
}

bool is_right_of(ivec4 edge, ivec2 pixel) {
    return edge.y * pixel.x - edge.x * pixel.y >= edge.z;
}

bool is_on(ivec4 line, ivec2 pixel) {
    int off = line.y * pixel.x - line.x * pixel.y + line.z;
    ivec2 size = abs(line.xy);
    int most = max(size.x, size.y);
    int along = size.x >= size.y ? pixel.x : pixel.y;
    // Halves instead of doubling what may nearly fill 32 bits.
    return off >= -(most >> 1) && off < (most + 1) >> 1 && along >= (line.w & 0xffff) && along < line.w >> 16;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy) - ivec2(writes.x & 0xffffu, writes.x >> 16);
    bvec4 crossed = bvec4(crosses(edge0, pixel), crosses(edge1, pixel), crosses(edge2, pixel), crosses(edge3, pixel));
    bvec4 right =
        bvec4(is_right_of(edge0, pixel), is_right_of(edge1, pixel), is_right_of(edge2, pixel), is_right_of(edge3, pixel));
    bool any_right = (crossed.x && right.x) || (crossed.y && right.y) || (crossed.z && right.z) || (crossed.w && right.w);
    bool any_left =
        (crossed.x && !right.x) || (crossed.y && !right.y) || (crossed.z && !right.z) || (crossed.w && !right.w);
    bool is_filled = any_right && any_left;
    bool is_edge = is_on(line0, pixel) || is_on(line1, pixel) || is_on(line2, pixel) || is_on(line3, pixel);
    // What lies left or above wraps around and is far right or below.
    bool inside = all(lessThan(uvec2(pixel), uvec2(writes.y & 0xffffu, writes.y >> 16)));
    bool is_written = inside && (is_filled || is_edge);
    uint packing = PACKING;
    // Where the largest value stays, nothing is nought.
    if (packing != PACK_MAX && !is_written) discard;
    uint word = is_written ? writes.z + (is_edge ? writes.w : 0u) : 0u;
    colour = unpackUnorm4x8(word);
}
