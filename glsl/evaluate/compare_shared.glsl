// Compares a tile through shared memory, for devices without shuffles: texels are laid down, and every invocation takes up four
// pixels of one candidate.

#ifndef EVALUATE_COMPARE_SHARED
#define EVALUATE_COMPARE_SHARED

#include "evaluate/compare_channel.glsl"

// One longer than needed: at the length of SegmentTable's numbers the compiler takes their type for it, whose explicit layout shared
// memory must not have.
shared uint words[MOST_COMPARE_GROUP + 1u];
shared uvec4 totals[MOST_COMPARE_GROUP];

// For the first four invocations alone.
uvec4 over_channel(uvec4 counted) {
    uint unit = gl_LocalInvocationID.x;
    uint group = gl_WorkGroupSize.x;
    totals[unit] = counted;
    for (uint half_way = group / 2u; half_way >= 4u; half_way >>= 1) {
        barrier();
        if (unit < half_way) totals[unit] += totals[unit + half_way];
    }
    counted = totals[unit];
#ifdef SEGMENTED
    barrier();
#endif
    return counted;
}

void main() {
    Tile tile = own_tile();
    uint rows = own_rows(tile);
    uint unit = gl_LocalInvocationID.x;
    uint channel = unit & 3u;
    uint texels = rows * tile.width;
    uint steps = (texels + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x;
    Walk walk = walk_from(unit, tile.width);
#ifdef SEGMENTED
    load_numbers(tile);
#endif
    Source source = source_of(tile, channel);
    Total total = nothing();
    for (uint i = 0u; i < steps; i++) {
        uint y = row_of(walk);
        words[unit] = walk.row < rows ? texelFetch(framebuffer, tile.origin + ivec2(walk.x, y), 0).x : 0u;
        barrier();
        uint drawn = 0u;
        for (uint pixel = 0u; pixel < 4u; pixel++) {
            drawn |= ((words[(unit & ~3u) + pixel] >> (8u * channel)) & 0xffu) << (8u * pixel);
        }
        barrier();
        if (drawn != 0u) add_word(drawn, int(y * tile.row_words + (walk.x >> 2)), source, total);
        advance(walk);
    }
    total = over_channel(total);
    if (unit < 4u) add_to_sums(tile, channel, total);
}

#endif
