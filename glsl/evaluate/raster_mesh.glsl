// The mesh drawn and compared without any framebuffer (docs/RASTER.md, METHOD A6). Some workgroups take an image, tile by tile of
// pixels in shared memory. A pixel is a key: its depth, then edges before fills, then larger labels first. The smallest key is what shows, so
// triangles and edges come in any order.
//
// Areas and depths are exact: a depth is estimated in floating point, and what is left over in whole numbers says by how much it is
// off. Small triangles take 32 bits, which wrap around where only what is left over matters; the others take 64.

#define SUMMED

#include "arithmetic/words64.glsl"
#include "evaluate/mesh.glsl"
#include "evaluate/raster_counts.glsl"

layout(local_size_x = MESH_RASTER_GROUP) in;

// [image][vertex]
layout(std430, set = 0, binding = 1) readonly buffer AllSeen { Seen seen[]; };
// Three vertices a triangle.
layout(std430, set = 0, binding = 4) readonly buffer Triangles { uint triangles[]; };
layout(std430, set = 0, binding = 10) readonly buffer Vertices { MeshVertex vertices[]; };
layout(std430, set = 0, binding = 11) readonly buffer Edges { MeshEdge edges[]; };

// What no fill or edge is as far as.
const uint NOTHING = 0xffffffffu;
// Of a key: set in fills alone.
const uint FILL = 128u;
const uint LABEL = 127u;

// A triangle that may cover more pixels of a tile than this is drawn by the whole workgroup, if there is room in its list.
const int FEW_PIXELS = 64;
const uint MOST_LARGE = 256u;

shared uint keys[MESH_KEYS];
shared uint large[MOST_LARGE];
shared uint large_count;

// The pixels of the tile, first and past the last, and keys of one of its rows.
ivec2 tile_low;
ivec2 tile_end;
int stride;

void paint(ivec2 pixel, uint depth, uint code) {
    ivec2 at = pixel - tile_low;
    atomicMin(keys[at.y * stride + at.x], depth << 8 | code);
}

// The code of a label in a key.
uint label_code(uint vertex) {
    return LABEL - (vertices[vertex].label & LABEL);
}

// A vertex's depth as a whole number: the nearest to 2^24 times it, at most 2^24 - 1.
int depth_number(float depth) {
    float scaled = depth * 16777216.0;
    return min(int(depth < 0.5 ? floor(scaled + 0.5) : scaled), 0xffffff);
}

int cross32(ivec2 u, ivec2 v) {
    return u.x * v.y - u.y * v.x;
}

uvec2 cross64(ivec2 u, ivec2 v) {
    return difference64(words_product64(u.x, v.y), words_product64(u.y, v.x));
}

// Of the pixels on an edge of a triangle that is clockwise to the eye those of a left or a horizontal top edge are inside: 0 for such
// an edge, else 1, the least area inside.
int least_area(ivec2 along) {
    return along.y < 0 || (along.y == 0 && along.x > 0) ? 0 : 1;
}

// A triangle that shows, and the pixels of the tile that it may cover, first and past the last.
struct Facing {
    ivec2 a;
    ivec2 b;
    ivec2 c;
    ivec3 depths;
    uint code;
    bool is_small; // less than 128 pixels a side, its area below 2^30 units, its depths less than 2^19 apart
    ivec2 first;
    ivec2 end;
};

// Every `stride_of`-th of its pixels, row by row, from the one numbered `from` on.
void fill_small(Facing it, int from, int stride_of) {
    ivec2 to_c = it.c - it.a;
    ivec2 from_b = it.a - it.b;
    ivec2 centre = it.first << 8;
    int whole = cross32(to_c, it.b - it.a);
    int least_b = least_area(to_c);
    int least_c = least_area(from_b);
    int least_a = least_area(it.b - it.c);
    // Weights of b and c: the areas opposite to them.
    int first_b = cross32(to_c, centre - it.a);
    int first_c = cross32(from_b, centre - it.b);
    int db = it.depths.y - it.depths.x;
    int dc = it.depths.z - it.depths.x;
    float inverse = 1.0 / float(whole);
    ivec2 size = it.end - it.first;
    int x = from % size.x;
    int y = from / size.x;
    while (y < size.y) {
        int area_b = first_b + 256 * (to_c.x * y - to_c.y * x);
        int area_c = first_c + 256 * (from_b.x * y - from_b.y * x);
        int area_a = whole - area_b - area_c;
        if (((area_a - least_a) | (area_b - least_b) | (area_c - least_c)) >= 0) {
            // Off by at most one: depths differ by less than 2^19 units.
            float share = (float(area_b) * float(db) + float(area_c) * float(dc)) * inverse;
            int nearest = int(floor(share + 0.5));
            // The rest, which is to be from 0 to below the whole, with a whole added: below 3 x 2^30.
            uint rest = uint(area_b * db + area_c * dc + (whole >> 1) - nearest * whole) + uint(whole);
            nearest += rest < uint(whole) ? -1 : rest >= 2u * uint(whole) ? 1 : 0;
            paint(it.first + ivec2(x, y), uint(it.depths.x + nearest), it.code);
        }
        x += stride_of;
        if (x >= size.x) {
            y += x / size.x;
            x %= size.x;
        }
    }
}

// The same of any triangle.
void fill_any(Facing it, int from, int stride_of) {
    uvec2 whole = cross64(it.c - it.a, it.b - it.a);
    uvec2 half_whole = uvec2((whole.x >> 1) | (whole.y << 31), whole.y >> 1);
    uvec2 least_a = extended64(least_area(it.b - it.c));
    uvec2 least_b = extended64(least_area(it.c - it.a));
    uvec2 least_c = extended64(least_area(it.a - it.b));
    int db = it.depths.y - it.depths.x;
    int dc = it.depths.z - it.depths.x;
    float inverse = 1.0 / real64(whole);
    ivec2 size = it.end - it.first;
    for (int at = from; at < size.x * size.y; at += stride_of) {
        ivec2 pixel = it.first + ivec2(at % size.x, at / size.x);
        uvec2 area_b = cross64(it.c - it.a, (pixel << 8) - it.a);
        uvec2 area_c = cross64(it.a - it.b, (pixel << 8) - it.b);
        uvec2 area_a = difference64(difference64(whole, area_b), area_c);
        if (is_negative64(difference64(area_a, least_a)) || is_negative64(difference64(area_b, least_b)) ||
            is_negative64(difference64(area_c, least_c))) continue;
        float share = (real64(area_b) * float(db) + real64(area_c) * float(dc)) * inverse;
        int nearest = int(floor(share + 0.5));
        uvec2 rest = sum64(product64(area_b, extended64(db)), product64(area_c, extended64(dc)));
        rest = difference64(sum64(rest, half_whole), product64(whole, extended64(nearest)));
        while (is_negative64(rest)) {
            rest = sum64(rest, whole);
            nearest--;
        }
        while (!is_negative64(difference64(rest, whole))) {
            rest = difference64(rest, whole);
            nearest++;
        }
        paint(pixel, uint(it.depths.x + nearest), it.code);
    }
}

void fill(Facing it, int from, int stride_of) {
    if (it.is_small) {
        fill_small(it, from, stride_of);
    } else {
        fill_any(it, from, stride_of);
    }
}

// Whether a triangle shows in the tile.
bool is_facing(uint triangle, uint from, out Facing it) {
    uint at = 3u * triangle;
    uint corner = triangles[at];
    Seen a = seen[from + corner];
    Seen b = seen[from + triangles[at + 1u]];
    Seen c = seen[from + triangles[at + 2u]];
    if (!has_image(a) || !has_image(b) || !has_image(c)) return false;
    ivec2 low = min(min(a.at, b.at), c.at);
    ivec2 high = max(max(a.at, b.at), c.at);
    // The first centre at or after the low end, and past the last at or before the high one.
    it.first = max((low + 255) >> 8, tile_low);
    it.end = min((high >> 8) + 1, tile_end);
    if (it.first.x >= it.end.x || it.first.y >= it.end.y || !faces_camera(a.at, b.at, c.at)) return false;
    it.a = a.at;
    it.b = b.at;
    it.c = c.at;
    it.depths = ivec3(depth_number(a.depth), depth_number(b.depth), depth_number(c.depth));
    ivec2 apart = abs(it.depths.yz - it.depths.x);
    ivec2 size = high - low;
    it.code = FILL | label_code(corner);
    it.is_small = max(size.x, size.y) < 32768 && float(size.x) * float(size.y) < 1.0e9 && max(apart.x, apart.y) < 0x80000;
    return true;
}

// All triangles: what touches few pixels of the tile is one invocation's, the rest is shared out.
void fill_triangles(uint from) {
    Facing it;
    for (uint triangle = gl_LocalInvocationID.x; triangle < batch.triangles; triangle += MESH_RASTER_GROUP) {
        if (!is_facing(triangle, from, it)) continue;
        ivec2 size = it.end - it.first;
        if (size.x * size.y > FEW_PIXELS) {
            uint place = atomicAdd(large_count, 1u);
            if (place < MOST_LARGE) {
                large[place] = triangle;
                continue;
            }
        }
        fill(it, 0, 1);
    }
    barrier();
    uint count = min(large_count, MOST_LARGE);
    for (uint place = 0u; place < count; place++) {
        if (is_facing(large[place], from, it)) fill(it, int(gl_LocalInvocationID.x), int(MESH_RASTER_GROUP));
    }
}

// delta x step / steps to the nearest whole number, halves upwards; 0 of no steps.
int nearest_share(int delta, int step, int steps) {
    int twice = 2 * max(steps, 1);
    int nearest = int(floor(2.0 * float(delta) * float(step) / float(twice) + 0.5));
    // Small, whatever the products do.
    int rest = 2 * delta * step + steps - nearest * twice;
    while (rest < 0) {
        rest += twice;
        nearest--;
    }
    while (rest >= twice) {
        rest -= twice;
        nearest++;
    }
    return nearest;
}

void draw_edge(MeshEdge edge, uint from) {
    Seen p = seen[from + edge.ends.x];
    Seen q = seen[from + edge.ends.y];
    if (!has_image(p) || !has_image(q)) return;
    ivec2 start = (p.at + 128) >> 8;
    ivec2 stop = (q.at + 128) >> 8;
    ivec2 low = min(start, stop);
    ivec2 high = max(start, stop);
    if (high.x < tile_low.x || high.y < tile_low.y || low.x >= tile_end.x || low.y >= tile_end.y) return;
    Seen l = seen[from + edge.opposite.x];
    Seen r = seen[from + edge.opposite.y];
    if (!has_image(l) || !has_image(r) || !is_silhouette(p.at, q.at, l.at, r.at)) return;
    int near = depth_number(p.edge_depth);
    int change = depth_number(q.edge_depth) - near;
    uint code = label_code(edge.ends.x);
    // Along the longer side, a step a pixel.
    ivec2 way = stop - start;
    bool is_flat = abs(way.x) >= abs(way.y);
    int along = is_flat ? way.x : way.y;
    int across = is_flat ? way.y : way.x;
    int steps = abs(along);
    int forward = along < 0 ? -1 : 1;
    int begin = is_flat ? start.x : start.y;
    int first_kept = is_flat ? tile_low.x : tile_low.y;
    int last_kept = (is_flat ? tile_end.x : tile_end.y) - 1;
    int first_step = max(forward > 0 ? first_kept - begin : begin - last_kept, 0);
    int last_step = min(forward > 0 ? last_kept - begin : begin - first_kept, steps);
    for (int step = first_step; step <= last_step; step++) {
        ivec2 moved = ivec2(forward * step, nearest_share(across, step, steps));
        ivec2 pixel = start + (is_flat ? moved : moved.yx);
        if (any(lessThan(pixel, tile_low)) || any(greaterThanEqual(pixel, tile_end))) continue;
        paint(pixel, uint(near + nearest_share(change, step, steps)), code);
    }
}

// Counts 32 pixels of the tile, from `place` on; invocations begin at different ones of their banks of memory.
void count_keys(inout uvec4 sum, uint place, uint group, int columns) {
    uint drawn = 0u;
    uint edges_drawn = 0u;
#if defined(SEGMENTED) || defined(EVIDENCE)
    uvec4 shown = uvec4(0u);
#endif
    for (uint step = 0u; step < 32u; step++) {
        uint pixel = (step + gl_LocalInvocationID.x) & 31u;
        uint key = keys[place + pixel];
        if (key == NOTHING) continue;
        uint bit = 1u << pixel;
        drawn |= bit;
        edges_drawn |= (key & FILL) == 0u ? bit : 0u;
#ifdef SEGMENTED
        shown |= number_bits(table.numbers[LABEL - (key & LABEL)]) & bit;
#endif
#ifdef EVIDENCE
        shown |= number_bits(table.classes[LABEL - (key & LABEL)]) & bit;
#endif
    }
    uint inside = counting(columns, group);
#ifdef SEGMENTED
    count_drawn(sum, group, drawn & inside, edges_drawn & inside, shown);
#else
    count_drawn(sum, group, drawn & inside, edges_drawn & inside);
#endif
#ifdef EVIDENCE
    for (uint number = 0u; number < table.count; number++) {
        uvec4 same = ~(shown ^ number_bits(number));
        uint own = same.x & same.y & same.z & same.w & drawn & inside;
        if (own != 0u) count_codes(group, number, own);
    }
#endif
}

// Sums of the invocation's pixels: area of the model, overlap, edges, proximity. The workgroups of an image take its tiles in turn.
uvec4 rasterise(uint image) {
    Camera camera = cameras[image % batch.views];
    Bounds box = bounds[image];
    uvec4 sum = uvec4(0u);
    // Nothing to draw: the same for all invocations.
    if (box.low.x >= box.high.x || box.low.y >= box.high.y) return sum;
    uint unit = gl_LocalInvocationID.x;
    uint from = image * batch.vertices;
    // Tiles begin at a word of the picture, and are about as many words wide, each.
    int first_word = box.low.x >> 5;
    int end_word = (box.high.x + 31) >> 5;
    int abreast = (end_word - first_word + int(MESH_WORDS) - 1) / int(MESH_WORDS);
    int words = (end_word - first_word + abreast - 1) / abreast;
    stride = 32 * words;
    int rows = int(MESH_KEYS) / stride;
    int tiles = abreast * ((box.high.y - box.low.y + rows - 1) / rows);
    for (int tile = int(gl_WorkGroupID.y); tile < tiles; tile += int(gl_NumWorkGroups.y)) {
        int word = first_word + tile % abreast * words;
        int y = box.low.y + tile / abreast * rows;
        tile_low = ivec2(32 * word, y);
        tile_end = min(tile_low + ivec2(stride, rows), box.high);
        uint count = uint(words * (tile_end.y - y));
        barrier();
        for (uint key = unit; key < 32u * count; key += MESH_RASTER_GROUP) keys[key] = NOTHING;
        if (unit == 0u) large_count = 0u;
        barrier();
        fill_triangles(from);
        for (uint edge = unit; edge < batch.edges; edge += MESH_RASTER_GROUP) draw_edge(edges[edge], from);
        barrier();
        for (uint place = unit; place < count; place += MESH_RASTER_GROUP) {
            uint row = place / uint(words);
            uint column = place - row * uint(words);
            uint group = camera.first_plane_word + (uint(y) + row) * camera.words + uint(word) + column;
            count_keys(sum, 32u * place, group, int(camera.size.x) - 32 * (word + int(column)));
        }
    }
    return sum;
}
