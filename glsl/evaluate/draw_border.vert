#version 450
#extension GL_GOOGLE_include_directive : require

// The four border lines of a part between its corners rounded to pixels, for the device's own lines. Four vertices a part,
// an instance an image.

#include "evaluate/constants.glsl"
#include "evaluate/draw.glsl"

layout(location = 0) flat out uvec3 writes;

void main() {
    uint place = uint(gl_VertexIndex) >> 2;
    uint corner = uint(gl_VertexIndex) & 3u;
    Placed part = placed(uint(gl_InstanceIndex), place);
    gl_Position = NOWHERE;
    writes = uvec3(0u);
    if (!part.is_drawn) return;
    writes = uvec3(part.placement.low, part.placement.high, part.base + part.edge);
    gl_Position = border_corner(part, corner);
}
