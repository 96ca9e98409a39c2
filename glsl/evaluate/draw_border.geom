#version 450
#extension GL_GOOGLE_include_directive : require

// What `draw_border.vert` makes of four vertices a part, of one point.

#include "evaluate/constants.glsl"
#include "evaluate/draw.glsl"

layout(points) in;
layout(line_strip, max_vertices = 8) out;

layout(location = 0) flat in uvec2 instance_and_place[];
layout(location = 0) flat out uvec3 writes;

void main() {
    Placed part = placed(instance_and_place[0].x, instance_and_place[0].y);
    if (!part.is_drawn) return;
    // Lines of their own, as vertices alone make them.
    for (uint side = 0u; side < 4u; side++) {
        for (uint end = 0u; end < 2u; end++) {
            writes = uvec3(part.placement.low, part.placement.high, part.base + part.edge);
            gl_Position = border_corner(part, (side + end) & 3u);
            EmitVertex();
        }
        EndPrimitive();
    }
}
