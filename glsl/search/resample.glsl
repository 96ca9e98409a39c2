// Systematic resampling: particles of a next batch in proportion to the weights of the previous ones.

#include "search/frame.glsl"
#include "search/outcome.glsl"

layout(std430, set = 0, binding = 2) readonly buffer Previous { float previous[]; };
// Sums of the weights up to and with each previous particle, low and high word.
layout(std430, set = 0, binding = 3) readonly buffer Cumulated { uvec2 cumulated[]; };

// The first previous particle of `count` whose sum is beyond the pointer of `particle`.
uint chosen_for(uint particle, uint iteration, uint count) {
    uint fraction = random_words(iteration, 0u, DRAW_RESAMPLING, 0u).x;
    uint offset = wide_product(outcome.stride, fraction).y;
    uvec2 pointer = wide_sum(wide_product(particle, outcome.stride), uvec2(offset, 0u));
    uint low = 0u;
    uint high = count - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (wide_less(pointer, cumulated[middle])) {
            high = middle;
        } else {
            low = middle + 1u;
        }
    }
    return low;
}
