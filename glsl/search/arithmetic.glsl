// Arithmetic that every device repeats to the bit; src/search/arithmetic.rs holds the same operations and says why.

#include "arithmetic/elementary.glsl"

// Low word in x, high word in y; by halves, since reflection cannot read umulExtended.
uvec2 wide_product(uint a, uint b) {
    uint a0 = a & 0xFFFFu, a1 = a >> 16;
    uint b0 = b & 0xFFFFu, b1 = b >> 16;
    uint across = a1 * b0;
    uint other = a0 * b1;
    uint middle = ((a0 * b0) >> 16) + (across & 0xFFFFu) + (other & 0xFFFFu);
    return uvec2(a * b, a1 * b1 + (across >> 16) + (other >> 16) + (middle >> 16));
}

uvec2 wide_sum(uvec2 a, uvec2 b) {
    uint low = a.x + b.x;
    return uvec2(low, a.y + b.y + (low < a.x ? 1u : 0u));
}

bool wide_less(uvec2 a, uvec2 b) {
    return a.y < b.y || (a.y == b.y && a.x < b.x);
}

// By its bits: a compiler may take it for granted that there is nothing else.
bool is_finite(float x) {
    return (floatBitsToUint(x) & 0x7F800000u) != 0x7F800000u;
}

// Integers of the same order as numbers, minus zero below zero; what is not finite is 0, less than anything.
uint total_order_of(float value) {
    uint bits = floatBitsToUint(value);
    if (!is_finite(value)) return 0u;
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

// An order with one zero from a total one.
uint with_one_zero(uint total_order) {
    return total_order == 0x7FFFFFFFu ? 0x80000000u : total_order;
}

// The same with one zero.
uint order_of(float value) {
    return with_one_zero(total_order_of(value));
}

// The nearest number within limits.
float hold(float x, float low, float high) {
    float held = x >= low ? x : low;
    return held <= high ? held : high;
}

// Sine in x, cosine in y.
vec2 turn(uint word) {
    uint quarter = word >> 30;
    precise float fraction = float((word >> 6) & 0x00FFFFFFu) * 5.96046448e-8 - 0.5;
    precise float x = fraction * 1.57079637;
    precise float s = x * x;
    precise float sine = x * (1.0 + s * (-0.166666672 + s * (8.33333377e-3 + s * (-1.98412701e-4 + s * 2.75573188e-6))));
    precise float cosine = 1.0 + s * (-0.5 + s * (4.16666679e-2 + s * (-1.38888892e-3 + s * 2.48015876e-5)));
    bool swap = (quarter & 1u) != 0u;
    uint a = floatBitsToUint(swap ? cosine : sine) ^ ((quarter & 2u) << 30);
    uint b = floatBitsToUint(swap ? sine : cosine) ^ (((quarter ^ (quarter >> 1)) & 1u) << 31);
    return vec2(uintBitsToFloat(a), uintBitsToFloat(b));
}

vec2 box_muller(uint w0, uint w1) {
    precise float u = (float(w0 >> 9) + 0.5) * 1.1920929e-7;
    precise float squared = -2.0 * ln(u);
    float radius = root(squared);
    vec2 both = turn(w1);
    precise vec2 normals = vec2(radius * both.y, radius * both.x);
    return normals;
}
