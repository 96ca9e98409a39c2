#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// The evidence of what a framebuffer shows (METHOD A6), however it is compared: an invocation reads four neighbouring texels, four
// pixels of each of four candidates, and looks up the code of each by the class of the part that shows there.

#define EVIDENCE
#include "evaluate/compare.glsl"

// The codes of four pixels, a word a pixel, placed as `pixels`.
layout(std430, set = 0, binding = 8) readonly buffer EvidencePixels { uvec4 evidence_pixels[]; };
// [candidate][view]
layout(std430, set = 0, binding = 9) buffer AllEvidence { int evidence[]; };

shared int totals[CANDIDATES_A_TILE];

// What four pixels of a channel add: their texels, and the word that they are of the tile as if it were the picture.
int weigh(uvec4 texels, Source source, int place) {
    uvec4 drawn = (texels >> (8u * source.channel)) & 0xffu;
    if (drawn == uvec4(0u)) return 0;
    uvec4 codes = evidence_pixels[clamp(source.from + place, 0, int(evidence_pixels.length()) - 1)];
    ivec4 values = ivec4((codes >> (4u * numbers_of(drawn, source))) & 15u) - int(EVIDENCE_NEUTRAL);
    values = mix(ivec4(0), values, notEqual(drawn, uvec4(0u)));
    return values.x + values.y + values.z + values.w;
}

void main() {
    Tile tile = own_tile();
    uint unit = gl_LocalInvocationID.x;
    uint words = own_rows(tile) * (tile.width >> 2);
    Walk walk = walk_from(unit, tile.width >> 2);
    if (unit < CANDIDATES_A_TILE) totals[unit] = 0;
    load_numbers(tile);
    Source source0 = source_of(tile, 0u);
    Source source1 = source_of(tile, 1u);
    Source source2 = source_of(tile, 2u);
    Source source3 = source_of(tile, 3u);
    ivec4 sum = ivec4(0);
    for (uint word = unit; word < words; word += gl_WorkGroupSize.x) {
        uint y = row_of(walk);
        ivec2 at = tile.origin + ivec2(4u * walk.x, y);
        uvec4 texels = uvec4(
            texelFetch(framebuffer, at, 0).x,
            texelFetch(framebuffer, at + ivec2(1, 0), 0).x,
            texelFetch(framebuffer, at + ivec2(2, 0), 0).x,
            texelFetch(framebuffer, at + ivec2(3, 0), 0).x
        );
        if (texels != uvec4(0u)) {
            int place = int(y * tile.row_words + walk.x);
            sum.x += weigh(texels, source0, place);
            sum.y += weigh(texels, source1, place);
            sum.z += weigh(texels, source2, place);
            sum.w += weigh(texels, source3, place);
        }
        advance(walk);
    }
    for (uint channel = 0u; channel < CANDIDATES_A_TILE; channel++) atomicAdd(totals[channel], sum[channel]);
    barrier();
    if (unit < tile.candidates) {
        uint image = (batch.first + tile.first_candidate + unit) * batch.views + tile.view;
        atomicAdd(evidence[image], totals[unit]);
    }
}
