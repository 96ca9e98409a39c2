#version 450
#extension GL_GOOGLE_include_directive : require

// Drawing and comparison segment by segment; sums meet in shared memory.

#define SEGMENTED
#include "evaluate/raster.glsl"

shared uint totals[4];

void main() {
    uint image = own_image();
    uint own = gl_LocalInvocationID.x;
    if (own < 4u) totals[own] = 0u;
    clear_segment(own);
    barrier();
    uvec4 sum = rasterise(image);
    for (uint part = 0u; part < 4u; part++) atomicAdd(totals[part], sum[part]);
    barrier();
    if (own == 0u) write_sums(image, uvec4(totals[0], totals[1], totals[2], totals[3]));
    if (own < MOST_SEGMENTS) {
        uint place = (batch.first * batch.views + image) * MOST_SEGMENTS + own;
        segment_sums[place] = segment_sum(own);
    }
}
