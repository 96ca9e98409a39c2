// Compares a tile without any exchange: an invocation reads four neighbouring texels, turns them into four pixels of each of
// the four candidates and compares all four; only the sums meet, in shared memory.

#ifndef EVALUATE_COMPARE_TEXELS
#define EVALUATE_COMPARE_TEXELS

#include "evaluate/compare.glsl"

// Of each channel four sums, and with segments eight fours.
shared uint shared_totals[16];
#ifdef SEGMENTED
// Eight would do; of 128, as many as SegmentTable's numbers, the compiler makes their type (compare_shared.glsl).
shared uint shared_segments[4u * 32u + 1u];
#endif

void add_to_shared(uint channel, Total total) {
    for (uint sum = 0u; sum < 4u; sum++) {
        atomicAdd(shared_totals[4u * channel + sum], total.whole[sum]);
#ifdef SEGMENTED
        uint segments = SEGMENTS;
        uint first = 32u * channel + sum;
        atomicAdd(shared_segments[first], total.areas[sum]);
        atomicAdd(shared_segments[first + 4u], total.overlaps[sum]);
        if (SEGMENT_EDGES) {
            atomicAdd(shared_segments[first + 8u], total.edges[sum]);
            atomicAdd(shared_segments[first + 12u], total.proximity[sum]);
        }
        if (segments > 4u) {
            atomicAdd(shared_segments[first + 16u], total.more_areas[sum]);
            atomicAdd(shared_segments[first + 20u], total.more_overlaps[sum]);
            if (SEGMENT_EDGES) {
                atomicAdd(shared_segments[first + 24u], total.more_edges[sum]);
                atomicAdd(shared_segments[first + 28u], total.more_proximity[sum]);
            }
        }
#endif
    }
}

Total shared_total(uint channel) {
    Total total = nothing();
    for (uint sum = 0u; sum < 4u; sum++) {
        total.whole[sum] = shared_totals[4u * channel + sum];
#ifdef SEGMENTED
        uint first = 32u * channel + sum;
        total.areas[sum] = shared_segments[first];
        total.overlaps[sum] = shared_segments[first + 4u];
        total.edges[sum] = shared_segments[first + 8u];
        total.proximity[sum] = shared_segments[first + 12u];
        total.more_areas[sum] = shared_segments[first + 16u];
        total.more_overlaps[sum] = shared_segments[first + 20u];
        total.more_edges[sum] = shared_segments[first + 24u];
        total.more_proximity[sum] = shared_segments[first + 28u];
#endif
    }
    return total;
}

void main() {
    Tile tile = own_tile();
    uint rows = own_rows(tile);
    uint unit = gl_LocalInvocationID.x;
    uint words = rows * (tile.width >> 2);
    Walk walk = walk_from(unit, tile.width >> 2);
    if (unit < 16u) shared_totals[unit] = 0u;
#ifdef SEGMENTED
    for (uint at = unit; at < 4u * 32u; at += gl_WorkGroupSize.x) shared_segments[at] = 0u;
    load_numbers(tile);
#endif
    Source source0 = source_of(tile, 0u);
    Source source1 = source_of(tile, 1u);
    Source source2 = source_of(tile, 2u);
    Source source3 = source_of(tile, 3u);
    Total total0 = nothing();
    Total total1 = nothing();
    Total total2 = nothing();
    Total total3 = nothing();
    for (uint word = unit; word < words; word += gl_WorkGroupSize.x) {
        uint y = row_of(walk);
        ivec2 at = tile.origin + ivec2(4u * walk.x, y);
        uint t0 = texelFetch(framebuffer, at, 0).x;
        uint t1 = texelFetch(framebuffer, at + ivec2(1, 0), 0).x;
        uint t2 = texelFetch(framebuffer, at + ivec2(2, 0), 0).x;
        uint t3 = texelFetch(framebuffer, at + ivec2(3, 0), 0).x;
        if ((t0 | t1 | t2 | t3) != 0u) {
            int place = int(y * tile.row_words + walk.x);
            // Transposes 4 x 4 bytes.
            uint a = (t0 & 0xffffu) | (t2 << 16);
            uint b = (t1 & 0xffffu) | (t3 << 16);
            uint c = (t0 >> 16) | (t2 & 0xffff0000u);
            uint d = (t1 >> 16) | (t3 & 0xffff0000u);
            add_word((a & 0x00ff00ffu) | ((b & 0x00ff00ffu) << 8), place, source0, total0);
            add_word(((a >> 8) & 0x00ff00ffu) | (b & 0xff00ff00u), place, source1, total1);
            add_word((c & 0x00ff00ffu) | ((d & 0x00ff00ffu) << 8), place, source2, total2);
            add_word(((c >> 8) & 0x00ff00ffu) | (d & 0xff00ff00u), place, source3, total3);
        }
        advance(walk);
    }
    barrier();
    add_to_shared(0u, total0);
    add_to_shared(1u, total1);
    add_to_shared(2u, total2);
    add_to_shared(3u, total3);
    barrier();
    if (unit < 4u) add_to_sums(tile, unit, shared_total(unit));
}

#endif
