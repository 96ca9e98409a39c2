#version 450
#extension GL_GOOGLE_include_directive : require

// Drawing and comparison on a device without subgroup arithmetic: sums meet in shared memory.

#include "evaluate/raster.glsl"

shared uvec4 partial[MOST_RASTER_GROUP];

void main() {
    uint image = own_image();
    uint own = gl_LocalInvocationID.x;
    uint group = gl_WorkGroupSize.x;
    partial[own] = rasterise(image);
    for (uint half_of = group / 2u; half_of > 0u; half_of >>= 1) {
        barrier();
        if (own < half_of) partial[own] += partial[own + half_of];
    }
    if (own == 0u) write_sums(image, partial[0]);
}
