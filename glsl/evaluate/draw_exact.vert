#version 450
#extension GL_GOOGLE_include_directive : require

// One rectangle a part, large enough for its fill and its border; the fragment stage decides each pixel by the exact rule
// (docs/RASTER.md). Four vertices a part, an instance an image.

#include "evaluate/draw_rectangle.glsl"

void main() {
    Placed part = placed(uint(gl_InstanceIndex), uint(gl_VertexIndex) >> 2);
    gl_Position = NOWHERE;
    edge0 = ivec4(0);
    edge1 = ivec4(0);
    edge2 = ivec4(0);
    edge3 = ivec4(0);
    line0 = ivec4(0);
    line1 = ivec4(0);
    line2 = ivec4(0);
    line3 = ivec4(0);
    writes = uvec4(0u);
    if (part.is_drawn) gl_Position = corner_of(rectangle_of(part), uint(gl_VertexIndex) & 3u);
}
