#version 450
#extension GL_GOOGLE_include_directive : require

// Every part of every candidate in every camera, once, by vertices: transform feedback captures them in the order of the body's
// parts. `order.comp` brings them into the order of depth.

#include "evaluate/world.glsl"
#include "evaluate/project_part.glsl"

// A Quad.
layout(xfb_buffer = 0, xfb_stride = 48) out;
layout(location = 0, xfb_offset = 0) flat out ivec4 corner_x;
layout(location = 1, xfb_offset = 16) flat out ivec4 corner_y;
layout(location = 2, xfb_offset = 32) flat out uvec4 rest;

void main() {
    uint image = uint(gl_VertexIndex) / batch.parts;
    Quad quad = project_part(image, uint(gl_VertexIndex) % batch.parts);
    // Points must have a size, drawn or not.
    gl_PointSize = 1.0;
    corner_x = quad.x;
    corner_y = quad.y;
    rest = uvec4(quad.drawn, quad.label, quad.part, floatBitsToUint(quad.depth_squared));
}
