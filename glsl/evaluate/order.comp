#version 450
#extension GL_GOOGLE_include_directive : require

// Projected parts in the body's order to parts in the order of depth: what follows transform feedback.

#include "evaluate/order.glsl"

layout(local_size_x = PROJECT_GROUP, local_size_x_id = 0) in;

layout(std430, set = 0, binding = 0) readonly buffer Cameras { Camera cameras[]; };
layout(std430, set = 0, binding = 1) readonly buffer Captured { Quad captured[]; };

void main() {
    Own own = own_part(gl_WorkGroupSize.x);
    Quad quad;
    if (own.is_active) quad = captured[own.image * batch.parts + own.part];
    write_in_order(own, quad, cameras[own.image % batch.views].size);
}
