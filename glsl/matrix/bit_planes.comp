#version 450
#extension GL_GOOGLE_include_directive : require

// Y = A B by bit planes (METHOD B5): y = sum over p, q of +-2^(p+q) |a_p & b_q|, minus where one of p and q is the sign's. An
// invocation an element of Y; a workgroup keeps the words that its rows and columns need at a time.

#include "matrix/constants.glsl"
#include "arithmetic/words64.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

// Of each row (column), plane by plane: 32 elements a word, so many words.
layout(std430, set = 0, binding = 0) readonly buffer RowPlanes { uint row_planes[]; };
layout(std430, set = 0, binding = 1) readonly buffer ColumnPlanes { uint column_planes[]; };
layout(std430, set = 0, binding = 2) writeonly buffer Product { uvec2 product[]; };

layout(push_constant) uniform Push {
    uint n;
    uint bits;
    uint words;
} push;

shared uint tile_rows[TILE * PLANES];
shared uint tile_columns[TILE * PLANES];

void main() {
    uint row = gl_WorkGroupID.y * TILE;
    uint column = gl_WorkGroupID.x * TILE;
    uint lane = gl_LocalInvocationIndex;
    uint mine = gl_LocalInvocationID.y * push.bits;
    uint other = gl_LocalInvocationID.x * push.bits;
    uint top = push.bits - 1u;
    uvec2 sum = uvec2(0u);
    for (uint word = 0u; word < push.words; word++) {
        for (uint i = lane; i < TILE * push.bits; i += TILE * TILE) {
            uint line = i / push.bits;
            uint plane = i % push.bits;
            bool inside = row + line < push.n;
            tile_rows[i] = inside ? row_planes[((row + line) * push.bits + plane) * push.words + word] : 0u;
            inside = column + line < push.n;
            tile_columns[i] = inside ? column_planes[((column + line) * push.bits + plane) * push.words + word] : 0u;
        }
        barrier();
        for (uint p = 0u; p < push.bits; p++) {
            uint a = tile_rows[mine + p];
            // Half of the planes at a time: 32 counts of 16 weights stay within a signed word.
            for (uint half_ = 0u; half_ < push.bits; half_ += 16u) {
                int part = 0;
                uint end = min(half_ + 16u, push.bits);
                for (uint q = half_; q < end; q++) {
                    int count = bitCount(a & tile_columns[other + q]) << (q - half_);
                    part += (p == top) != (q == top) ? -count : count;
                }
                sum = sum64(sum, shifted64(part, p + half_));
            }
        }
        barrier();
    }
    row += gl_LocalInvocationID.y;
    column += gl_LocalInvocationID.x;
    if (row < push.n && column < push.n) product[row * push.n + column] = sum;
}
