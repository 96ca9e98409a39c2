#version 450
#extension GL_GOOGLE_include_directive : require

// Every part of every candidate in every camera, once; the quads of an image are written nearest first.

#include "evaluate/order.glsl"
#include "evaluate/world.glsl"
#include "evaluate/project_part.glsl"

layout(local_size_x = PROJECT_GROUP, local_size_x_id = 0) in;

void main() {
    Own own = own_part(gl_WorkGroupSize.x);
    Quad quad;
    if (own.is_active) quad = project_part(own.image, own.part);
    write_in_order(own, quad, cameras[own.image % batch.views].size);
}
