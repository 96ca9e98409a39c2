// Signed numbers of 64 bits as two words, the lower first.

#ifndef MATRIX_WORDS64
#define MATRIX_WORDS64

uvec2 sum64(uvec2 a, uvec2 b) {
    uint low = a.x + b.x;
    return uvec2(low, a.y + b.y + (low < b.x ? 1u : 0u));
}

// A signed word, shifted up by 0 to 63 places.
uvec2 shifted64(int word, uint places) {
    uint high = uint(word >> 31);
    if (places == 0u) return uvec2(uint(word), high);
    if (places > 31u) return uvec2(0u, uint(word) << (places - 32u));
    return uvec2(uint(word) << places, (high << places) | (uint(word) >> (32u - places)));
}

#endif
