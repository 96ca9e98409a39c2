#version 450
#extension GL_GOOGLE_include_directive : require

// Drawing and comparison with the evidence of what is drawn; sums meet in shared memory.

#define EVIDENCE
#include "evaluate/raster.glsl"

shared uint totals[5];

void main() {
    uint image = own_image();
    uint own = gl_LocalInvocationID.x;
    if (own < 5u) totals[own] = 0u;
    barrier();
    uvec4 sum = rasterise(image);
    for (uint part = 0u; part < 4u; part++) atomicAdd(totals[part], sum[part]);
    atomicAdd(totals[4], codes);
    barrier();
    if (own != 0u) return;
    write_sums(image, uvec4(totals[0], totals[1], totals[2], totals[3]));
    evidence[batch.first * batch.views + image] = int(totals[4]) - int(EVIDENCE_NEUTRAL) * int(totals[0]);
}
