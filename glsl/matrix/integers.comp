#version 450
#extension GL_GOOGLE_include_directive : require

// Y = A B by multiplying and adding integers: what bit planes are measured against. An invocation an element of Y; a workgroup
// keeps a square of A and one of B at a time.

#include "matrix/constants.glsl"
#include "arithmetic/words64.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

layout(std430, set = 0, binding = 0) readonly buffer A { int a[]; };
layout(std430, set = 0, binding = 1) readonly buffer B { int b[]; };
layout(std430, set = 0, binding = 2) writeonly buffer Product { uvec2 product[]; };

// 1 where sums need more than 32 bits.
layout(constant_id = 0) const uint WIDE = 0u;

layout(push_constant) uniform Push {
    uint n;
} push;

shared int tile_a[TILE * TILE];
shared int tile_b[TILE * TILE];

void main() {
    uint row = gl_GlobalInvocationID.y;
    uint column = gl_GlobalInvocationID.x;
    uint x = gl_LocalInvocationID.x;
    uint y = gl_LocalInvocationID.y;
    uint wide = WIDE;
    int narrow = 0;
    uvec2 sum = uvec2(0u);
    for (uint first = 0u; first < push.n; first += TILE) {
        bool inside = row < push.n && first + x < push.n;
        tile_a[y * TILE + x] = inside ? a[row * push.n + first + x] : 0;
        inside = column < push.n && first + y < push.n;
        tile_b[y * TILE + x] = inside ? b[(first + y) * push.n + column] : 0;
        barrier();
        if (wide == 0u) {
            for (uint k = 0u; k < TILE; k++) narrow += tile_a[y * TILE + k] * tile_b[k * TILE + x];
        } else {
            for (uint k = 0u; k < TILE; k++) {
                int high, low;
                imulExtended(tile_a[y * TILE + k], tile_b[k * TILE + x], high, low);
                sum = sum64(sum, uvec2(uint(low), uint(high)));
            }
        }
        barrier();
    }
    if (row < push.n && column < push.n) {
        product[row * push.n + column] = wide == 0u ? shifted64(narrow, 0u) : sum;
    }
}
