// Philox 4x32-10 and the addresses of random numbers, as in src/search/philox.rs.

#include "search/arithmetic.glsl"

const uint DRAW_COGNITIVE = 0u;
const uint DRAW_SOCIAL = 1u;
const uint DRAW_SCATTER = 2u;
const uint DRAW_RESAMPLING = 3u;

uvec4 philox(uvec4 counter, uvec2 key) {
    uvec4 c = counter;
    for (int i = 0; i < 10; i++) {
        uvec2 first = wide_product(c.x, 0xD2511F53u);
        uvec2 second = wide_product(c.z, 0xCD9E8D57u);
        c = uvec4(second.y ^ c.y ^ key.x, second.x, first.y ^ c.w ^ key.y, first.x);
        key += uvec2(0x9E3779B9u, 0xBB67AE85u);
    }
    return c;
}

// A block is four words, for dimensions eight apart.
uint dimension_of(uint block, uint word) {
    return 32u * (block / 8u) + 8u * word + block % 8u;
}

vec4 uniforms_of(uvec4 words) {
    return vec4(words >> 8) * 5.96046448e-8;
}

vec4 normals_of(uvec4 words) {
    return vec4(box_muller(words.x, words.y), box_muller(words.z, words.w));
}
