// Single precision as the reference computes it: every operation rounded on its own, in the stated order, no fused
// multiply-add, no library sine. `precise` forbids the compiler to regroup.

#ifndef EVALUATE_ARITHMETIC
#define EVALUATE_ARITHMETIC

#include "evaluate/constants.glsl"

// Sine in x, cosine in y: reduction by multiples of pi/2 in three pieces, then minimax polynomials (Cephes).
vec2 sin_cos(float x) {
    const float ROUND = 12582912.0; // 1.5 * 2^23: adding it rounds to the nearest integer
    precise float scaled = x * 0.636619747;
    precise float shifted = scaled + ROUND;
    uint quadrant = floatBitsToUint(shifted);
    precise float n = shifted - ROUND;
    precise float n1 = n * 1.5703125;
    precise float n2 = n * 4.837513e-4;
    precise float n3 = n * 7.549790e-8;
    precise float r1 = x - n1;
    precise float r2 = r1 - n2;
    precise float r = r2 - n3;
    precise float z = r * r;
    precise float s = r + r * z * (-1.6666655e-1 + z * (8.332161e-3 + z * -1.9515296e-4));
    precise float c = (1.0 - 0.5 * z) + z * z * (4.1666646e-2 + z * (-1.3887316e-3 + z * 2.4433157e-5));
    bool swap = (quadrant & 1u) != 0u;
    float sine = swap ? c : s;
    float cosine = swap ? s : c;
    sine = uintBitsToFloat(floatBitsToUint(sine) ^ ((quadrant & 2u) << 30));
    cosine = uintBitsToFloat(floatBitsToUint(cosine) ^ (((quadrant + 1u) & 2u) << 30));
    return vec2(sine, cosine);
}

float dot3(vec3 a, vec3 b) {
    precise float sum = (a.x * b.x + a.y * b.y) + a.z * b.z;
    return sum;
}

vec3 cross3(vec3 a, vec3 b) {
    precise vec3 product = vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
    return product;
}

vec3 scale3(vec3 a, float s) {
    precise vec3 product = vec3(a.x * s, a.y * s, a.z * s);
    return product;
}

// One row of a 3x4 matrix applied to a point.
float transform_row(vec4 row, vec3 p) {
    precise float sum = ((row.x * p.x + row.y * p.y) + row.z * p.z) + row.w;
    return sum;
}

vec3 transform(vec4 row0, vec4 row1, vec4 row2, vec3 p) {
    return vec3(transform_row(row0, p), transform_row(row1, p), transform_row(row2, p));
}

// A pixel coordinate to 1/256 pixel: nearest, halves towards +infinity.
int snap(float coordinate) {
    precise float scaled = coordinate * 256.0 + 0.5;
    return int(floor(scaled));
}

#endif
