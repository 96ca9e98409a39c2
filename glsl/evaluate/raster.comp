#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require

// Drawing and comparison on a device that sums over subgroups.

#include "evaluate/raster.glsl"

shared uint totals[4];

void main() {
    if (gl_LocalInvocationID.x < 4u) totals[gl_LocalInvocationID.x] = 0u;
    uint image = own_image();
    uvec4 sum = rasterise(image);
    sum = subgroupAdd(sum);
    barrier();
    if (gl_SubgroupInvocationID == 0u) {
        atomicAdd(totals[0], sum.x);
        atomicAdd(totals[1], sum.y);
        atomicAdd(totals[2], sum.z);
        atomicAdd(totals[3], sum.w);
    }
    barrier();
    if (gl_LocalInvocationID.x == 0u) write_sums(image, uvec4(totals[0], totals[1], totals[2], totals[3]));
}
