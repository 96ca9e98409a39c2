// What an invocation counted of its own channel, summed over the invocations that share it.

#ifndef EVALUATE_COMPARE_CHANNEL
#define EVALUATE_COMPARE_CHANNEL

#include "evaluate/compare.glsl"

// The sum over the invocations of the same channel, which each way of gathering finds its own way; all invocations call it.
uvec4 over_channel(uvec4 counted);

Total over_channel(Total total) {
    total.whole = over_channel(total.whole);
#ifdef SEGMENTED
    uint segments = SEGMENTS;
    total.areas = over_channel(total.areas);
    total.overlaps = over_channel(total.overlaps);
    if (SEGMENT_EDGES) {
        total.edges = over_channel(total.edges);
        total.proximity = over_channel(total.proximity);
    }
    if (segments > 4u) {
        total.more_areas = over_channel(total.more_areas);
        total.more_overlaps = over_channel(total.more_overlaps);
        if (SEGMENT_EDGES) {
            total.more_edges = over_channel(total.more_edges);
            total.more_proximity = over_channel(total.more_proximity);
        }
    }
#endif
    return total;
}

#endif
