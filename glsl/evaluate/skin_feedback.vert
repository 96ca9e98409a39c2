#version 450
#extension GL_GOOGLE_include_directive : require

// Every vertex of every candidate in every camera, by vertices: transform feedback captures them in the order in which they are drawn
// from, [candidate][view][vertex]. `touched.comp` finds what they touch.

#include "evaluate/posed_vertex.glsl"

// A Seen.
layout(xfb_buffer = 0, xfb_stride = 16) out;
layout(location = 0, xfb_offset = 0) flat out ivec4 captured;

void main() {
    uint image = uint(gl_VertexIndex) / batch.vertices;
    vec3 point = posed_vertex(image / batch.views, uint(gl_VertexIndex) % batch.vertices);
    Seen own = seen_from(cameras[image % batch.views], point);
    // Points must have a size, drawn or not.
    gl_PointSize = 1.0;
    captured = ivec4(own.at, floatBitsToInt(own.depth), floatBitsToInt(own.edge_depth));
}
