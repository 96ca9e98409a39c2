// Compares a tile through shared memory, for devices without shuffles: texels are laid down, and every invocation takes up four
// pixels of one candidate.

#ifndef EVALUATE_COMPARE_SHARED
#define EVALUATE_COMPARE_SHARED

#include "evaluate/compare.glsl"

layout(local_size_x = COMPARE_GROUP) in;

// One longer than needed: at the length of SegmentTable's numbers the compiler takes their type for it, whose explicit layout shared
// memory must not have.
shared uint words[COMPARE_GROUP + 1u];
shared uvec4 totals[COMPARE_GROUP];

// The sum over the invocations of the same channel, for the first four; all invocations call it.
uvec4 over_group(uint unit, uvec4 total) {
    totals[unit] = total;
    for (uint half_way = COMPARE_GROUP / 2u; half_way >= 4u; half_way >>= 1) {
        barrier();
        if (unit < half_way) totals[unit] += totals[unit + half_way];
    }
    total = totals[unit];
#ifdef SEGMENTED
    barrier();
#endif
    return total;
}

void main() {
    Tile tile = own_tile();
    uint rows = own_rows(tile);
    uint unit = gl_LocalInvocationID.x;
    uint channel = unit & 3u;
    uint texels = rows * tile.width;
    uint steps = (texels + COMPARE_GROUP - 1u) / COMPARE_GROUP;
    uint width = max(tile.width, 1u);
    uint x = unit % width;
    uint row = unit / width;
    uint step_x = COMPARE_GROUP % width;
    uint step_rows = COMPARE_GROUP / width;
#ifdef SEGMENTED
    load_numbers(tile);
#endif
    Source source = source_of(tile, channel);
    Total total = nothing();
    for (uint i = 0u; i < steps; i++) {
        uint y = gl_WorkGroupID.y + row * gl_NumWorkGroups.y;
        words[unit] = row < rows ? texelFetch(framebuffer, tile.origin + ivec2(x, y), 0).x : 0u;
        barrier();
        uint drawn = 0u;
        for (uint pixel = 0u; pixel < 4u; pixel++) {
            drawn |= ((words[(unit & ~3u) + pixel] >> (8u * channel)) & 0xffu) << (8u * pixel);
        }
        barrier();
        if (drawn != 0u) add_word(drawn, int(y * tile.row_words + (x >> 2)), source, total);
        x += step_x;
        row += step_rows;
        if (x >= width) {
            x -= width;
            row++;
        }
    }
    total.whole = over_group(unit, total.whole);
#ifdef SEGMENTED
    uint segments = SEGMENTS;
    total.areas = over_group(unit, total.areas);
    total.overlaps = over_group(unit, total.overlaps);
    if (segments > 4u) {
        total.more_areas = over_group(unit, total.more_areas);
        total.more_overlaps = over_group(unit, total.more_overlaps);
    }
#endif
    if (unit < 4u) add_to_sums(tile, channel, total);
}

#endif
