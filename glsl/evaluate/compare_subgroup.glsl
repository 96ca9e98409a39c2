// Compares a tile by subgroups: an invocation reads a texel, four candidates' pixels; four invocations exchange bytes until
// each holds four pixels of one candidate. Sums are reduced over the subgroup, whatever its size from 4 on, and however much of it
// there is: a device may tell another size than a subgroup has invocations.

#ifndef EVALUATE_COMPARE_SUBGROUP
#define EVALUATE_COMPARE_SUBGROUP

#include "evaluate/compare_channel.glsl"

// Invocations of every subgroup, all of which are full, where the pipeline holds them to that; else 0.
layout(constant_id = 31) const uint FULL_SUBGROUP = 0u;

// Places of the workgroup that subgroups have taken.
shared uint taken;

// Invocations of the own subgroup.
uint lanes;

uvec4 over_channel(uvec4 counted) {
    for (uint distance = 4u; distance < lanes; distance <<= 1) {
        counted.x += subgroupShuffleXor(counted.x, distance);
        counted.y += subgroupShuffleXor(counted.y, distance);
        counted.z += subgroupShuffleXor(counted.z, distance);
        counted.w += subgroupShuffleXor(counted.w, distance);
    }
    return counted;
}

void main() {
    Tile tile = own_tile();
    uint rows = own_rows(tile);
    uint full = FULL_SUBGROUP;
    uint first = 0u;
    if (full > 0u) {
        lanes = full;
        first = gl_SubgroupID * lanes;
    } else {
        if (gl_LocalInvocationID.x == 0u) taken = 0u;
        barrier();
        lanes = subgroupAdd(1u);
        if (gl_SubgroupInvocationID == 0u) first = atomicAdd(taken, lanes);
        first = subgroupShuffle(first, 0u);
    }
    uint unit = first + gl_SubgroupInvocationID;
    uint channel = gl_SubgroupInvocationID & 3u;
    uint texels = rows * tile.width;
    uint steps = (texels + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x;
    Walk walk = walk_from(unit, tile.width);
#ifdef SEGMENTED
    load_numbers(tile);
#endif
    Source source = source_of(tile, channel);
    Total total = nothing();
    // The same number of steps for all, since all take part in the exchange.
    for (uint i = 0u; i < steps; i++) {
        uint y = row_of(walk);
        bool inside = walk.row < rows;
        uint own = inside ? texelFetch(framebuffer, tile.origin + ivec2(walk.x, y), 0).x : 0u;
        // Transposes 4 x 4 bytes: halves with the invocation two away, then bytes with the neighbour.
        uint other = subgroupShuffleXor(own, 2u);
        own = (channel & 2u) == 0u ? (own & 0xffffu) | (other << 16) : (other >> 16) | (own & 0xffff0000u);
        other = subgroupShuffleXor(own, 1u);
        own = (channel & 1u) == 0u ? (own & 0x00ff00ffu) | ((other & 0x00ff00ffu) << 8)
                                   : ((other >> 8) & 0x00ff00ffu) | (own & 0xff00ff00u);
        if (own != 0u) add_word(own, int(y * tile.row_words + (walk.x >> 2)), source, total);
        advance(walk);
    }
    total = over_channel(total);
    if (gl_SubgroupInvocationID < 4u) add_to_sums(tile, channel, total);
}

#endif
