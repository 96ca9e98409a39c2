#version 450
#extension GL_GOOGLE_include_directive : require

// What `draw_exact.vert` makes of four vertices a part, of one point: no index buffer, and what the fragment stage decides by is found once
// a part.

#include "evaluate/draw_rectangle.glsl"
#include "evaluate/strip.glsl"

layout(points) in;
layout(triangle_strip, max_vertices = 4) out;

layout(location = 0) flat in uvec2 instance_and_place[];

void main() {
    Placed part = placed(instance_and_place[0].x, instance_and_place[0].y);
    if (!part.is_drawn) return;
    Rectangle rectangle = rectangle_of(part);
    ivec4 edges[4] = ivec4[4](edge0, edge1, edge2, edge3);
    ivec4 lines[4] = ivec4[4](line0, line1, line2, line3);
    uvec4 written = writes;
    for (uint corner = 0u; corner < 4u; corner++) {
        // Every vertex takes them along.
        edge0 = edges[0];
        edge1 = edges[1];
        edge2 = edges[2];
        edge3 = edges[3];
        line0 = lines[0];
        line1 = lines[1];
        line2 = lines[2];
        line3 = lines[3];
        writes = written;
        gl_Position = corner_of(rectangle, STRIP[corner]);
        EmitVertex();
    }
    EndPrimitive();
}
