// Compares a tile by subgroups: an invocation reads a texel, four candidates' pixels; four invocations exchange bytes until
// each holds four pixels of one candidate. Sums are reduced over the subgroup, whatever its size from 4 on.

#ifndef EVALUATE_COMPARE_SUBGROUP
#define EVALUATE_COMPARE_SUBGROUP

#include "evaluate/compare.glsl"

layout(local_size_x = COMPARE_GROUP) in;

// The sum over the invocations of the same channel.
uvec4 over_subgroup(uvec4 total) {
    for (uint distance = 4u; distance < gl_SubgroupSize; distance <<= 1) {
        total.x += subgroupShuffleXor(total.x, distance);
        total.y += subgroupShuffleXor(total.y, distance);
        total.z += subgroupShuffleXor(total.z, distance);
        total.w += subgroupShuffleXor(total.w, distance);
    }
    return total;
}

void main() {
    Tile tile = own_tile();
    uint rows = own_rows(tile);
    uint unit = gl_SubgroupID * gl_SubgroupSize + gl_SubgroupInvocationID;
    uint channel = gl_SubgroupInvocationID & 3u;
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
    // The same number of steps for all, since all take part in the exchange.
    for (uint i = 0u; i < steps; i++) {
        uint y = gl_WorkGroupID.y + row * gl_NumWorkGroups.y;
        bool inside = row < rows;
        uint own = inside ? texelFetch(framebuffer, tile.origin + ivec2(x, y), 0).x : 0u;
        // Transposes 4 x 4 bytes: halves with the invocation two away, then bytes with the neighbour.
        uint other = subgroupShuffleXor(own, 2u);
        own = (channel & 2u) == 0u ? (own & 0xffffu) | (other << 16) : (other >> 16) | (own & 0xffff0000u);
        other = subgroupShuffleXor(own, 1u);
        own = (channel & 1u) == 0u ? (own & 0x00ff00ffu) | ((other & 0x00ff00ffu) << 8)
                                   : ((other >> 8) & 0x00ff00ffu) | (own & 0xff00ff00u);
        if (own != 0u) add_word(own, int(y * tile.row_words + (x >> 2)), source, total);
        x += step_x;
        row += step_rows;
        if (x >= width) {
            x -= width;
            row++;
        }
    }
    total.whole = over_subgroup(total.whole);
#ifdef SEGMENTED
    uint segments = SEGMENTS;
    total.areas = over_subgroup(total.areas);
    total.overlaps = over_subgroup(total.overlaps);
    if (segments > 4u) {
        total.more_areas = over_subgroup(total.more_areas);
        total.more_overlaps = over_subgroup(total.more_overlaps);
    }
#endif
    if (gl_SubgroupInvocationID < 4u) add_to_sums(tile, channel, total);
}

#endif
