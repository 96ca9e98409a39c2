#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Compares a tile without any exchange: an invocation reads four neighbouring texels, turns them into four pixels of each of
// the four candidates and compares all four; only the sums meet, in shared memory.

#include "evaluate/compare.glsl"

layout(local_size_x = COMPARE_GROUP) in;

shared uint shared_totals[16];

void main() {
    Tile tile = own_tile();
    uint rows = own_rows(tile);
    uint unit = gl_LocalInvocationID.x;
    uint width = max(tile.width >> 2, 1u);
    uint words = rows * (tile.width >> 2);
    uint x = unit % width;
    uint row = unit / width;
    uint step_x = COMPARE_GROUP % width;
    uint step_rows = COMPARE_GROUP / width;
    int from0 = observed_from(tile, 0u);
    int from1 = observed_from(tile, 1u);
    int from2 = observed_from(tile, 2u);
    int from3 = observed_from(tile, 3u);
    if (unit < 16u) shared_totals[unit] = 0u;
    uvec4 total0 = uvec4(0u);
    uvec4 total1 = uvec4(0u);
    uvec4 total2 = uvec4(0u);
    uvec4 total3 = uvec4(0u);
    for (uint word = unit; word < words; word += COMPARE_GROUP) {
        uint y = gl_WorkGroupID.y + row * gl_NumWorkGroups.y;
        ivec2 at = tile.origin + ivec2(4u * x, y);
        uint t0 = texelFetch(framebuffer, at, 0).x;
        uint t1 = texelFetch(framebuffer, at + ivec2(1, 0), 0).x;
        uint t2 = texelFetch(framebuffer, at + ivec2(2, 0), 0).x;
        uint t3 = texelFetch(framebuffer, at + ivec2(3, 0), 0).x;
        if ((t0 | t1 | t2 | t3) != 0u) {
            int place = int(y * tile.row_words + x);
            // Transposes 4 x 4 bytes.
            uint a = (t0 & 0xffffu) | (t2 << 16);
            uint b = (t1 & 0xffffu) | (t3 << 16);
            uint c = (t0 >> 16) | (t2 & 0xffff0000u);
            uint d = (t1 >> 16) | (t3 & 0xffff0000u);
            add_word((a & 0x00ff00ffu) | ((b & 0x00ff00ffu) << 8), observed(from0 + place), total0);
            add_word(((a >> 8) & 0x00ff00ffu) | (b & 0xff00ff00u), observed(from1 + place), total1);
            add_word((c & 0x00ff00ffu) | ((d & 0x00ff00ffu) << 8), observed(from2 + place), total2);
            add_word(((c >> 8) & 0x00ff00ffu) | (d & 0xff00ff00u), observed(from3 + place), total3);
        }
        x += step_x;
        row += step_rows;
        if (x >= width) {
            x -= width;
            row++;
        }
    }
    barrier();
    for (uint sum = 0u; sum < 4u; sum++) {
        atomicAdd(shared_totals[sum], total0[sum]);
        atomicAdd(shared_totals[4u + sum], total1[sum]);
        atomicAdd(shared_totals[8u + sum], total2[sum]);
        atomicAdd(shared_totals[12u + sum], total3[sum]);
    }
    barrier();
    if (unit < 4u) {
        uint first = 4u * unit;
        add_to_sums(tile, unit, uvec4(shared_totals[first], shared_totals[first + 1u], shared_totals[first + 2u],
                                      shared_totals[first + 3u]));
    }
}
