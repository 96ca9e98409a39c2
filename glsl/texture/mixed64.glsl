// The library's mixing of seeds and counters.

#ifndef TEXTURE_MIXED64
#define TEXTURE_MIXED64

#include "arithmetic/words64.glsl"

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
