#version 450
#extension GL_GOOGLE_include_directive : require

// The mesh drawn and compared; sums meet in shared memory, then in those of the image.

#include "evaluate/raster_mesh.glsl"

void main() {
    begin_totals();
    add_sums(own_image(), rasterise(own_image()));
}
