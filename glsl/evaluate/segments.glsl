// Silhouettes compared segment by segment (docs/RASTER.md).

#ifndef EVALUATE_SEGMENTS
#define EVALUATE_SEGMENTS

#include "evaluate/constants.glsl"

// Sums of one segment of a candidate image, without area_obs.
struct SegmentSum {
    uint area_model;
    uint overlap;
};

#endif
