// Whole numbers of 64 bits as pairs of words, the lower one first: sums and products wrap around, signed ones are in two's complement.

#ifndef ARITHMETIC_WORDS64
#define ARITHMETIC_WORDS64

uvec2 sum64(uvec2 a, uvec2 b) {
    uint low = a.x + b.x;
    return uvec2(low, a.y + b.y + (low < a.x ? 1u : 0u));
}

uvec2 difference64(uvec2 a, uvec2 b) {
    return uvec2(a.x - b.x, a.y - b.y - (a.x < b.x ? 1u : 0u));
}

uvec2 product64(uvec2 a, uvec2 b) {
    uint high, low;
    umulExtended(a.x, b.x, high, low);
    return uvec2(low, high + a.x * b.y + a.y * b.x);
}

// A signed word.
uvec2 extended64(int value) {
    return uvec2(uint(value), uint(value >> 31));
}

// The product of signed words.
uvec2 words_product64(int a, int b) {
    int high, low;
    imulExtended(a, b, high, low);
    return uvec2(uint(low), uint(high));
}

// A signed word, shifted up by 0 to 63 places.
uvec2 shifted64(int word, uint places) {
    uint high = uint(word >> 31);
    if (places == 0u) return uvec2(uint(word), high);
    if (places > 31u) return uvec2(0u, uint(word) << (places - 32u));
    return uvec2(uint(word) << places, (high << places) | (uint(word) >> (32u - places)));
}

bool is_negative64(uvec2 a) {
    return int(a.y) < 0;
}

// About the signed number.
float real64(uvec2 a) {
    return float(int(a.y)) * 4294967296.0 + float(a.x);
}

#endif
