#version 450
#extension GL_GOOGLE_include_directive : require

// The mesh drawn and compared with the evidence of what is drawn; sums meet in shared memory, then in those of the image.

#define EVIDENCE
#include "evaluate/raster_mesh.glsl"

shared uint all_codes;

void main() {
    uint image = own_image();
    if (gl_LocalInvocationID.x == 0u) all_codes = 0u;
    begin_totals();
    uvec4 sum = rasterise(image);
    atomicAdd(all_codes, codes);
    add_sums(image, sum);
    if (gl_LocalInvocationID.x != 0u || totals[0] == 0u) return;
    atomicAdd(evidence[batch.first * batch.views + image], int(all_codes) - int(EVIDENCE_NEUTRAL) * int(totals[0]));
}
