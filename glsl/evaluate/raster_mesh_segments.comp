#version 450
#extension GL_GOOGLE_include_directive : require

// The mesh drawn and compared segment by segment; sums meet in shared memory, then in those of the image.

#define SEGMENTED
#include "evaluate/raster_mesh.glsl"

void main() {
    uint image = own_image();
    uint own = gl_LocalInvocationID.x;
    if (own < MOST_SEGMENTS) {
        segment_areas[own] = 0u;
        segment_overlaps[own] = 0u;
    }
    begin_totals();
    add_sums(image, rasterise(image));
    if (own < MOST_SEGMENTS && segment_areas[own] != 0u) {
        uint place = (batch.first * batch.views + image) * MOST_SEGMENTS + own;
        atomicAdd(segment_sums[place].area_model, segment_areas[own]);
        atomicAdd(segment_sums[place].overlap, segment_overlaps[own]);
    }
}
