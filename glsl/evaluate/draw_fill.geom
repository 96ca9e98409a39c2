#version 450
#extension GL_GOOGLE_include_directive : require

// What `draw_fill.vert` makes of four vertices a part, of one point.

#include "evaluate/constants.glsl"
#include "evaluate/draw.glsl"
#include "evaluate/strip.glsl"

layout(points) in;
layout(triangle_strip, max_vertices = 4) out;

layout(location = 0) flat in uvec2 instance_and_place[];
layout(location = 0) flat out uvec3 writes;

void main() {
    Placed part = placed(instance_and_place[0].x, instance_and_place[0].y);
    if (!part.is_drawn) return;
    for (uint corner = 0u; corner < 4u; corner++) {
        writes = uvec3(part.placement.low, part.placement.high, part.base);
        gl_Position = fill_corner(part, STRIP[corner]);
        EmitVertex();
    }
    EndPrimitive();
}
