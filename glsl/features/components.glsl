// Connected components of a bit picture, as a forest over runs: the set pixels of a word that lie side by side are a node, and a
// node's label is another node of its component that comes no later in reading order. Union by the earlier node makes the root of a
// component its first run, whatever order the device works in.

#ifndef FEATURES_COMPONENTS
#define FEATURES_COMPONENTS

#include "features/constants.glsl"
#include "features/place.glsl"

layout(push_constant) uniform Components {
    uint width;
    uint height;
    uint stride;
    uint most;   // of the largest: how many; of the holes: pixels of the largest
    uint least;  // of the largest: pixels
    float share; // of the largest: as a fraction of the largest of all
    uint cover;  // of the largest: pixels of all components together beyond which none is kept
} push;

// Set beside a component's area: it is kept, or touches what it must or must not.
const uint MARK = 0x80000000u;

// Runs of a word begin two pixels apart at least.
uint node(uint place, uint start) {
    return place * 16u + (start >> 1u);
}

// The first pixel of the run that holds a set pixel of a word.
uint run_start(uint word, uint bit) {
    uint gaps = ~word & ((1u << bit) - 1u);
    return gaps == 0u ? 0u : uint(findMSB(gaps)) + 1u;
}

// The pixels of the run that begins with a word's lowest set pixel.
uint first_run(uint word) {
    uint start = uint(findLSB(word));
    uint gaps = ~(word >> start);
    if (gaps == 0u) return word;
    uint count = uint(findLSB(gaps));
    return ((1u << count) - 1u) << start;
}

#endif
