// What drawing without a framebuffer counts, 32 pixels of a row at a time (METHOD A6): the observation is bit planes, so that
// everything counted is a bit count. Shared by the flat model and the mesh, which say what `batch` is and, by SUMMED, whether sums are
// written or added to.

#ifndef EVALUATE_RASTER_COUNTS
#define EVALUATE_RASTER_COUNTS

#include "evaluate/constants.glsl"
#include "evaluate/model.glsl"

// Whether there are pixels that do not count.
layout(constant_id = 1) const bool IGNORES = false;

layout(std430, set = 0, binding = 0) readonly buffer Cameras { Camera cameras[]; };
layout(std430, set = 0, binding = 2) readonly buffer AllBounds { Bounds bounds[]; };
// Two vectors for 32 pixels of a row: planes 0..=3, then planes 4..=6 and the silhouette.
layout(std430, set = 0, binding = 3) readonly buffer Planes { uvec4 planes[]; };
layout(std430, set = 0, binding = 5) SUMMED buffer AllSums { Sums sums[]; };
// A word for 32 pixels of a row: those that count.
layout(std430, set = 0, binding = 9) readonly buffer Counted { uint counted[]; };

#ifdef SEGMENTED
// Whether edges and proximity are counted by segments too, not areas alone.
layout(constant_id = 4) const bool SEGMENT_EDGES = false;

layout(std430, set = 0, binding = 6) readonly buffer SegmentTable {
    float weights[MOST_SEGMENTS];
    uint numbers[LABELS]; // of each label, 0 for none
    uint areas[];         // observed pixels, [view][segment]
} table;
// A word a segment for 32 pixels of a row.
layout(std430, set = 0, binding = 7) readonly buffer SegmentPlanes { uint segment_planes[]; };
// [candidate][view][segment]
layout(std430, set = 0, binding = 8) SUMMED buffer AllSegmentSums { Sums segment_sums[]; };

shared uint segment_areas[MOST_SEGMENTS];
shared uint segment_overlaps[MOST_SEGMENTS];
shared uint segment_edges[MOST_SEGMENTS];
shared uint segment_proximities[MOST_SEGMENTS];

// Begins the sums of the workgroup; an invocation a segment.
void clear_segment(uint own) {
    if (own >= MOST_SEGMENTS) return;
    segment_areas[own] = 0u;
    segment_overlaps[own] = 0u;
    segment_edges[own] = 0u;
    segment_proximities[own] = 0u;
}

// What the workgroup has counted of a segment.
Sums segment_sum(uint own) {
    return Sums(segment_areas[own], segment_overlaps[own], segment_edges[own], segment_proximities[own]);
}
#endif

#ifdef EVIDENCE
layout(std430, set = 0, binding = 6) readonly buffer EvidenceTable {
    uint classes[LABELS]; // of each label
    uint count;           // classes
    uint best[];          // [view]
} table;
// The bits of the codes of 32 pixels of a row, [group][class].
layout(std430, set = 0, binding = 7) readonly buffer EvidencePlanes { uvec4 evidence_planes[]; };
// [candidate][view]
layout(std430, set = 0, binding = 8) SUMMED buffer AllEvidence { int evidence[]; };

// The codes of what the invocation's pixels show, added up.
uint codes = 0u;
#endif

// The four bits of a number, each in every bit of a word.
uvec4 number_bits(uint number) {
    return mix(uvec4(0u), uvec4(0xffffffffu), notEqual(uvec4(number) & uvec4(1u, 2u, 4u, 8u), uvec4(0u)));
}

// Bits of the pixels left of n, of a word that begins at 0.
uint below(int n) {
    return n >= 32 ? 0xffffffffu : (1u << uint(max(n, 0))) - 1u;
}

// Those of 32 pixels that count: inside of the picture, of which `columns` are left, and not ignored.
uint counting(int columns, uint group) {
    uint inside = below(columns);
    if (IGNORES && inside != 0u) inside &= counted[group];
    return inside;
}

// The proximity of edge pixels, added up: the bits of the observation there, planes 0..=3 and 4..=6.
uint proximity_of(uvec4 near, uvec3 far, uint edges) {
    uvec4 ones = uvec4(1u, 2u, 4u, 8u) * uvec4(bitCount(near & edges));
    uvec3 sixteens = uvec3(16u, 32u, 64u) * uvec3(bitCount(far & edges));
    return ones.x + ones.y + ones.z + ones.w + sixteens.x + sixteens.y + sixteens.z;
}

// Adds what is drawn on the pixels of a group that count: area of the model, overlap, edges, proximity.
#ifdef SEGMENTED
void count_drawn(inout uvec4 sum, uint group, uint drawn, uint edges, uvec4 shown) {
#else
void count_drawn(inout uvec4 sum, uint group, uint drawn, uint edges) {
#endif
    if (drawn == 0u) return;
    uvec4 near = planes[2u * group];
    uvec4 far = planes[2u * group + 1u];
#ifdef SEGMENTED
    for (uint segment = 0u; segment < MOST_SEGMENTS; segment++) {
        uvec4 same = ~(shown ^ number_bits(segment + 1u));
        uint own = same.x & same.y & same.z & same.w & drawn;
        if (own == 0u) continue;
        atomicAdd(segment_areas[segment], uint(bitCount(own)));
        uint both = own & segment_planes[MOST_SEGMENTS * group + segment];
        atomicAdd(segment_overlaps[segment], uint(bitCount(both)));
        uint border = own & edges;
        if (SEGMENT_EDGES && border != 0u) {
            atomicAdd(segment_edges[segment], uint(bitCount(border)));
            atomicAdd(segment_proximities[segment], proximity_of(near, far.xyz, border));
        }
    }
#endif
    sum.x += uint(bitCount(drawn));
    sum.y += uint(bitCount(drawn & far.w));
    sum.z += uint(bitCount(edges));
    sum.w += proximity_of(near, far.xyz, edges);
}

#ifdef EVIDENCE
// Adds the codes of a class where the bits are.
void count_codes(uint group, uint number, uint own) {
    uvec4 bits = evidence_planes[group * table.count + number];
    uvec4 counts = uvec4(1u, 2u, 4u, 8u) * uvec4(bitCount(bits & own));
    codes += counts.x + counts.y + counts.z + counts.w;
}
#endif

#endif
