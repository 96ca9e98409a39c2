// Framebuffer against observation, shared by all ways of gathering a candidate's pixels: resources, and the sums of a word of
// four pixels (METHOD A6, A9).

#ifndef EVALUATE_COMPARE
#define EVALUATE_COMPARE

#include "evaluate/constants.glsl"
#include "evaluate/model.glsl"
#include "evaluate/batch.glsl"
#include "evaluate/tiles.glsl"

layout(local_size_x = COMPARE_GROUP, local_size_x_id = 4) in;

layout(std430, set = 0, binding = 0) readonly buffer Placements { Placement placements[]; };
layout(std430, set = 0, binding = 1) readonly buffer Tiles {
    vec2 to_clip;
    ViewTiles tiles[];
};
layout(std430, set = 0, binding = 2) readonly buffer Cameras { Camera cameras[]; };
layout(std430, set = 0, binding = 3) readonly buffer Pixels { uint pixels[]; };
layout(std430, set = 0, binding = 4) buffer AllSums { Sums sums[]; };
layout(set = 0, binding = 5) uniform utexture2D framebuffer;

// The bit of a drawn byte that says edge. Below or above it lies the code of the part: the rank, 1 the farthest, or the label.
layout(constant_id = 0) const uint EDGE_BIT = 0u;

#ifndef EVIDENCE
// Whether there are pixels that do not count, and 0xff for each that does, placed as `pixels`.
layout(constant_id = 3) const bool IGNORES = false;
layout(std430, set = 0, binding = 10) readonly buffer Counted { uint counted[]; };
#endif

#ifdef SEGMENTED
// Whether edges and proximity are counted by segments too, not areas alone.
layout(constant_id = 5) const bool SEGMENT_EDGES = false;

layout(std430, set = 0, binding = 6) readonly buffer SegmentTable {
    float weights[MOST_SEGMENTS];
    uint numbers[LABELS]; // of each label, 0 for none
    uint areas[];
} table;
// The number of every observed pixel's segment, packed and placed as `pixels`.
layout(std430, set = 0, binding = 8) readonly buffer SegmentPixels { uint segment_pixels[]; };
// [candidate][view][segment]
layout(std430, set = 0, binding = 9) buffer AllSegmentSums { Sums segment_sums[]; };

layout(constant_id = 2) const uint SEGMENTS = 8u;

uint number_of_label(uint label) {
    return table.numbers[label];
}

uint largest_number() {
    return SEGMENTS;
}
#endif

#ifdef EVIDENCE
layout(std430, set = 0, binding = 6) readonly buffer EvidenceTable {
    uint classes[LABELS]; // of each label
    uint count;
    uint best[]; // [view]
} table;

uint number_of_label(uint label) {
    return table.classes[label];
}

uint largest_number() {
    return 7u;
}
#endif

#if defined(SEGMENTED) || defined(EVIDENCE)
#define NUMBERED
// Read where codes are ranks.
layout(std430, set = 0, binding = 7) readonly buffer Quads { Quad quads[]; };

// Codes that there may be: SHORT_CODES or LABELS.
layout(constant_id = 1) const uint CODES = 128u;

// The number of each code of each channel; of short codes as one word of bits for each bit of the number.
shared uint code_numbers[CANDIDATES_A_TILE * LABELS];
shared uint code_bits[CANDIDATES_A_TILE * 4u];
#endif

// What an invocation counts of one candidate.
struct Total {
    uvec4 whole; // as Sums
#ifdef SEGMENTED
    // Of the first four segments, and of the others; edges and proximity where they are asked for.
    uvec4 areas;
    uvec4 overlaps;
    uvec4 edges;
    uvec4 proximity;
    uvec4 more_areas;
    uvec4 more_overlaps;
    uvec4 more_edges;
    uvec4 more_proximity;
#endif
};

// Whose pixels an invocation compares.
struct Source {
    int from; // where the observation begins for the tile's origin, in words
#ifdef NUMBERED
    uint channel;
    uvec4 bits; // of `code_bits`
#endif
};

// The tile of a workgroup: what of it is in use, and what of that the workgroup takes - every nth row.
struct Tile {
    uint view;
    uint first_candidate;
    uint candidates;
    ivec2 origin;
    uint width;  // pixels in use, a multiple of four
    uint height; // rows in use
    uint row_words;
    uint first_word;
};

Tile own_tile() {
    Tile tile;
    uint group = gl_WorkGroupID.x / batch.views;
    tile.view = gl_WorkGroupID.x % batch.views;
    tile.first_candidate = group * CANDIDATES_A_TILE;
    tile.candidates = min(CANDIDATES_A_TILE, batch.candidates - tile.first_candidate);
    tile.origin = ivec2(tile_origin(tiles[tile.view], group));
    ivec2 high = tile.origin;
    for (uint channel = 0u; channel < tile.candidates; channel++) {
        Placement placement = placements[(tile.first_candidate + channel) * batch.views + tile.view];
        high = max(high, unpack_place(placement.high));
    }
    tile.width = (uint(high.x - tile.origin.x) + 3u) & ~3u;
    tile.height = uint(high.y - tile.origin.y);
    tile.row_words = (cameras[tile.view].size.x + 3u) >> 2;
    tile.first_word = cameras[tile.view].first_pixel_word;
    return tile;
}

// Rows that this workgroup takes of `tile`.
uint own_rows(Tile tile) {
    uint bands = gl_NumWorkGroups.y;
    return (tile.height + bands - 1u - gl_WorkGroupID.y) / bands;
}

// The way of an invocation through a tile: as many places on as the workgroup has invocations, in the
// rows that its workgroup takes.
struct Walk {
    uint x;
    uint row; // of those that the workgroup takes
    uint width;
    uint step_x;
    uint step_rows;
};

// From place `unit` on, in rows of `width` places.
Walk walk_from(uint unit, uint width) {
    Walk walk;
    walk.width = max(width, 1u);
    walk.x = unit % walk.width;
    walk.row = unit / walk.width;
    walk.step_x = gl_WorkGroupSize.x % walk.width;
    walk.step_rows = gl_WorkGroupSize.x / walk.width;
    return walk;
}

// The row of the tile.
uint row_of(Walk walk) {
    return gl_WorkGroupID.y + walk.row * gl_NumWorkGroups.y;
}

void advance(inout Walk walk) {
    walk.x += walk.step_x;
    walk.row += walk.step_rows;
    if (walk.x >= walk.width) {
        walk.x -= walk.width;
        walk.row++;
    }
}

// Where the observation of channel `channel` begins for the tile's origin, in words: it may lie outside of the picture where
// nothing is drawn.
int observed_from(Tile tile, uint channel) {
    if (channel >= tile.candidates) return 0;
    Placement placement = placements[(tile.first_candidate + channel) * batch.views + tile.view];
    ivec2 low = tile.origin - placement.shift;
    return int(tile.first_word) + low.y * int(tile.row_words) + (low.x >> 2);
}

// The observed word at `place`; anything where nothing is drawn.
uint observed(int place) {
    return pixels[clamp(place, 0, int(pixels.length()) - 1)];
}

#ifdef NUMBERED
// Finds the number of every code in the tile; all invocations call it.
void load_numbers(Tile tile) {
    uint codes = CODES;
    uint edge_bit = EDGE_BIT;
    if (gl_LocalInvocationID.x < CANDIDATES_A_TILE * 4u) code_bits[gl_LocalInvocationID.x] = 0u;
    barrier();
    for (uint i = gl_LocalInvocationID.x; i < CANDIDATES_A_TILE * codes; i += gl_WorkGroupSize.x) {
        uint channel = i / codes;
        uint code = i % codes;
        uint number = 0u;
        if (edge_bit != 0u) {
            number = code == 0u ? 0u : number_of_label(code);
        } else if (code > 0u && code <= batch.parts && channel < tile.candidates) {
            uint image = (tile.first_candidate + channel) * batch.views + tile.view;
            number = number_of_label(quads[image * batch.parts + batch.parts - code].label & (LABELS - 1u));
        }
        if (codes > SHORT_CODES) {
            code_numbers[i] = number;
        } else {
            for (uint bit = 0u; bit < 4u; bit++) {
                if ((number >> bit & 1u) == 1u) atomicOr(code_bits[4u * channel + bit], 1u << code);
            }
        }
    }
    barrier();
}

// The numbers of four drawn bytes.
uvec4 numbers_of(uvec4 drawn, Source source) {
    uint codes = CODES;
    uint edge_bit = EDGE_BIT;
    uvec4 code = (drawn >> (edge_bit == 0u ? 1u : 0u)) & (codes - 1u);
    if (codes > SHORT_CODES) {
        uvec4 at = source.channel * codes + code;
        return uvec4(code_numbers[at.x], code_numbers[at.y], code_numbers[at.z], code_numbers[at.w]);
    }
    uint largest = largest_number();
    uvec4 number = (uvec4(source.bits.x) >> code) & 1u;
    number |= ((uvec4(source.bits.y) >> code) & 1u) << 1;
    if (largest > 3u) number |= ((uvec4(source.bits.z) >> code) & 1u) << 2;
    if (largest > 7u) number |= ((uvec4(source.bits.w) >> code) & 1u) << 3;
    return number;
}
#endif

#ifdef SEGMENTED
// 0x80 in every byte that is 0, of bytes below 0x80.
uint zero_bytes(uint word) {
    return ~(word + 0x7f7f7f7fu) & 0x80808080u;
}

uvec4 zero_bytes(uvec4 words) {
    return ~(words + 0x7f7f7f7fu) & 0x80808080u;
}

// The sums of the four bytes of each word.
uvec4 byte_sums(uvec4 words) {
    uvec4 pairs = (words & 0x00ff00ffu) + ((words >> 8) & 0x00ff00ffu);
    return (pairs & 0xffffu) + (pairs >> 16);
}

// Adds four pixels of one candidate segment by segment: their drawn bytes and the observed numbers; of its edge pixels, 1 a byte, the
// proximity.
void add_segments(uint drawn, uint seen, uint edges, uint near, Source source, inout Total total) {
    uint segments = SEGMENTS;
    uvec4 number = numbers_of(uvec4(drawn) >> uvec4(0u, 8u, 16u, 24u), source);
    uint shown = number.x | number.y << 8 | number.z << 16 | number.w << 24;
    uint same = zero_bytes(shown ^ seen);
    uvec4 own = zero_bytes(uvec4(shown) ^ uvec4(0x01010101u, 0x02020202u, 0x03030303u, 0x04040404u));
    total.areas += uvec4(bitCount(own));
    total.overlaps += uvec4(bitCount(own & same));
    if (SEGMENT_EDGES && edges != 0u) {
        uvec4 border = (own >> 7) & edges;
        total.edges += uvec4(bitCount(border));
        total.proximity += byte_sums(near & (border * 0x7fu));
    }
    if (segments > 4u) {
        own = zero_bytes(uvec4(shown) ^ uvec4(0x05050505u, 0x06060606u, 0x07070707u, 0x08080808u));
        total.more_areas += uvec4(bitCount(own));
        total.more_overlaps += uvec4(bitCount(own & same));
        if (SEGMENT_EDGES && edges != 0u) {
            uvec4 border = (own >> 7) & edges;
            total.more_edges += uvec4(bitCount(border));
            total.more_proximity += byte_sums(near & (border * 0x7fu));
        }
    }
}
#endif

// Channel `channel` of the tile; with numbers after `load_numbers`.
Source source_of(Tile tile, uint channel) {
    Source source;
    source.from = observed_from(tile, channel);
#ifdef NUMBERED
    uint first = 4u * channel;
    source.channel = channel;
    source.bits = uvec4(code_bits[first], code_bits[first + 1u], code_bits[first + 2u], code_bits[first + 3u]);
#endif
    return source;
}

Total nothing() {
    Total total;
    total.whole = uvec4(0u);
#ifdef SEGMENTED
    total.areas = uvec4(0u);
    total.overlaps = uvec4(0u);
    total.edges = uvec4(0u);
    total.proximity = uvec4(0u);
    total.more_areas = uvec4(0u);
    total.more_overlaps = uvec4(0u);
    total.more_edges = uvec4(0u);
    total.more_proximity = uvec4(0u);
#endif
    return total;
}

#ifndef EVIDENCE
// Adds four pixels of one candidate: their drawn bytes, and the word that they are of the tile as if it were the picture.
void add_word(uint drawn, int place, Source source, inout Total total) {
    if (IGNORES) drawn &= counted[clamp(source.from + place, 0, int(counted.length()) - 1)];
    uint seen = observed(source.from + place);
    uint edge_bit = EDGE_BIT;
    uint filled = (((drawn & 0x7f7f7f7fu) + 0x7f7f7f7fu) | drawn) & 0x80808080u;
    uint edges = (drawn >> edge_bit) & 0x01010101u;
    uint near = seen & (edges * 0x7fu);
    total.whole.x += uint(bitCount(filled));
    total.whole.y += uint(bitCount(filled & seen));
    total.whole.z += uint(bitCount(edges));
    uint pairs = (near & 0x00ff00ffu) + ((near >> 8) & 0x00ff00ffu);
    total.whole.w += (pairs & 0xffffu) + (pairs >> 16);
#ifdef SEGMENTED
    if (drawn != 0u) {
        int at = clamp(source.from + place, 0, int(segment_pixels.length()) - 1);
        add_segments(drawn, segment_pixels[at], edges, near, source, total);
    }
#endif
}
#endif

void add_to_sums(Tile tile, uint channel, Total total) {
    if (channel >= tile.candidates || total.whole.x == 0u) return;
    uint image = (batch.first + tile.first_candidate + channel) * batch.views + tile.view;
    atomicAdd(sums[image].area_model, total.whole.x);
    atomicAdd(sums[image].overlap, total.whole.y);
    atomicAdd(sums[image].edges, total.whole.z);
    atomicAdd(sums[image].proximity, total.whole.w);
#ifdef SEGMENTED
    uint segments = SEGMENTS;
    for (uint segment = 0u; segment < segments; segment++) {
        uint own = segment & 3u;
        uint area = segment < 4u ? total.areas[own] : total.more_areas[own];
        uint overlap = segment < 4u ? total.overlaps[own] : total.more_overlaps[own];
        if (area == 0u) continue;
        uint at = image * MOST_SEGMENTS + segment;
        atomicAdd(segment_sums[at].area_model, area);
        atomicAdd(segment_sums[at].overlap, overlap);
        if (SEGMENT_EDGES) {
            atomicAdd(segment_sums[at].edges, segment < 4u ? total.edges[own] : total.more_edges[own]);
            atomicAdd(segment_sums[at].proximity, segment < 4u ? total.proximity[own] : total.more_proximity[own]);
        }
    }
#endif
}

#endif
