#version 450
#extension GL_GOOGLE_include_directive : require

// A part's corners as they are, for the device's own rasteriser: two triangles a part. Four vertices a part, an instance an
// image.

#include "evaluate/constants.glsl"
#include "evaluate/draw.glsl"

layout(location = 0) flat out uvec3 writes; // what may be touched, and the word

void main() {
    uint place = uint(gl_VertexIndex) >> 2;
    uint corner = uint(gl_VertexIndex) & 3u;
    Placed part = placed(uint(gl_InstanceIndex), place);
    gl_Position = NOWHERE;
    writes = uvec3(0u);
    if (!part.is_drawn) return;
    writes = uvec3(part.placement.low, part.placement.high, part.base);
    gl_Position = fill_corner(part, corner);
}
