// 64-bit whole numbers as pairs of words, the lower one first, for the library's mixing of seeds and counters.

#ifndef TEXTURE_WORD64
#define TEXTURE_WORD64

uvec2 product64(uvec2 a, uvec2 b) {
    uint high, low;
    umulExtended(a.x, b.x, high, low);
    return uvec2(low, high + a.x * b.y + a.y * b.x);
}

uvec2 sum64(uvec2 a, uvec2 b) {
    uint low = a.x + b.x;
    return uvec2(low, a.y + b.y + (low < a.x ? 1u : 0u));
}

// A whole number with its sign.
uvec2 extended64(int value) {
    return uvec2(uint(value), value < 0 ? 0xFFFFFFFFu : 0u);
}

// A well mixed word of a number (two rounds of multiply and shift).
uint mixed64(uvec2 number) {
    uvec2 x = number ^ uvec2(0xF3BCC908u, 0x6A09E667u);
    for (int round = 0; round < 2; round++) {
        x.x ^= x.y;
        x = product64(x, uvec2(0x6659FD93u, 0xD6E8FEB8u));
    }
    return x.x ^ x.y;
}

#endif
