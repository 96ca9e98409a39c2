// Drawing and comparison without any framebuffer (docs/RASTER.md, SPEC A6): the whole of both compute variants but for how a
// workgroup sums. A workgroup takes an image, an invocation a row. A chunk of the row is two sets of bits kept in registers, what
// fills cover and where borders show; the observation is bit planes, so everything counted is a bit count.
//
// Bounds of spans are exact in 32-bit arithmetic. Every one is of the form base + k s + floor((r + k t) / d), k rows below the
// first, 0 <= r, t < d: the floor is estimated in floating point, at most one off, and its remainder, which 32 bits hold
// whatever the products do, says which way.

#include "evaluate/constants.glsl"
#include "evaluate/model.glsl"
#include "evaluate/batch.glsl"

layout(local_size_x = RASTER_GROUP) in;

// Whether the images are those of the list, not all of the batch.
layout(constant_id = 0) const bool LISTED = false;

layout(std430, set = 0, binding = 0) readonly buffer Cameras { Camera cameras[]; };
layout(std430, set = 0, binding = 1) readonly buffer Quads { Quad quads[]; };
layout(std430, set = 0, binding = 2) readonly buffer AllBounds { Bounds bounds[]; };
// Two vectors for 32 pixels of a row: planes 0..=3, then planes 4..=6 and the silhouette.
layout(std430, set = 0, binding = 3) readonly buffer Planes { uvec4 planes[]; };
// Three words of a dispatch, then image numbers.
layout(std430, set = 0, binding = 4) readonly buffer List { uint list[]; };
layout(std430, set = 0, binding = 5) writeonly buffer AllSums { Sums sums[]; };

// Words of a row that are drawn at once.
const uint CHUNK = 2u;
// Parts whose edges are kept at once.
const uint TILE = 32u;
const uint EDGES = 128u;
// Chunks of the widest picture, 16384 pixels.
const uint MOST_CHUNKS = 256u;

// Of an edge of a part of the tile. Fill: rows, base, s, t; d, r; border: rows, columns; base, s, t and r, d. Rows and columns
// are first and past the last, in 16 bits each; the highest bit of a border's rows says that it is steep.
shared ivec4 fill_edge[EDGES];
shared ivec4 both_edge[EDGES];
shared ivec4 line_edge[EDGES];
// Rows of a part, packed alike, and for each chunk one bit a part that reaches into it.
shared uint part_rows[TILE];
shared uint part_columns[TILE];
shared uint chunk_parts[MOST_CHUNKS];

// Floor and remainder of a / d, d > 0.
ivec2 divide(int a, int d) {
    int quotient = a / d;
    int remainder = a - quotient * d;
    if (remainder < 0) {
        quotient--;
        remainder += d;
    }
    return ivec2(quotient, remainder);
}

uint pack_range(int first, int end) {
    return first < end ? uint(first) | (uint(end) << 16) : 0u;
}

// floor((r + k t) / d) and its remainder.
ivec2 step_to(int k, int t, int r, int d) {
    int quotient = int((float(t) * float(k) + float(r)) / float(d));
    int remainder = r + k * t - quotient * d;
    if (remainder < 0) {
        quotient--;
        remainder += d;
    } else if (remainder >= d) {
        quotient++;
        remainder -= d;
    }
    return ivec2(quotient, remainder);
}

// Bits of the pixels left of n, of a word that begins at 0.
uint below(int n) {
    return n >= 32 ? 0xffffffffu : (1u << uint(max(n, 0))) - 1u;
}

uint span_bits(int low, int high) {
    return below(high) & ~below(low);
}

// The first pixel at or right of the edge's crossing with the centres of row first + k.
void set_up_fill(uint edge, ivec2 p, ivec2 q, int height) {
    ivec2 top = p.y <= q.y ? p : q;
    ivec2 bottom = p.y <= q.y ? q : p;
    int first = max((top.y + 255) >> 8, 0);
    int end = min((bottom.y + 255) >> 8, height);
    uint rows = pack_range(first, end);
    ivec4 fill = ivec4(0);
    int d = 1;
    int r = 0;
    if (rows != 0u) {
        d = bottom.y - top.y;
        ivec2 slope = divide(bottom.x - top.x, d);
        // The crossing is at top.x + (s + t/d) m; t m / d is estimated, and the remainder tells how far off.
        int m = 256 * first - top.y;
        int estimate = int(float(slope.y) * float(m) / float(d));
        ivec2 rest = divide(slope.y * m - estimate * d, d);
        // 256 times the rounded-up crossing, less one unit of its denominator: x + rest / d.
        int x = top.x + slope.x * m + estimate + rest.x + 255 + (rest.y > 0 ? 1 : 0);
        uint below_unit = rest.y > 0 ? uint(rest.y - 1) : uint(d - 1);
        r = int((uint(x & 255) * uint(d) + below_unit) >> 8);
        fill = ivec4(int(rows), x >> 8, slope);
    }
    fill_edge[edge] = fill;
    both_edge[edge].x = d;
    both_edge[edge].y = r;
}

// Where the border begins in row first + k; it ends where it begins in the next row, or a pixel on when it is steep.
void set_up_line(uint edge, ivec2 p, ivec2 q, ivec2 size) {
    ivec2 top = p.y <= q.y ? p : q;
    ivec2 bottom = p.y <= q.y ? q : p;
    int first = max(top.y, 0);
    uint rows = pack_range(first, min(bottom.y + 1, size.y));
    int left = min(p.x, q.x);
    int right = max(p.x, q.x) + 1;
    uint columns = pack_range(clamp(left, 0, size.x), clamp(right, 0, size.x));
    ivec4 line = ivec4(left, right - left, 0, 1);
    bool steep = false;
    if (columns == 0u) rows = 0u;
    int d = bottom.y - top.y;
    if (rows != 0u && d > 0) {
        int dx = bottom.x - top.x;
        steep = d > abs(dx);
        ivec2 slope = divide(dx, d);
        // Steep: the nearest column, a tie to the larger. Flat: columns whose nearest row this is begin at the ceiling of the
        // crossing with row - 1/2 when x grows with the row, and end after its floor when x falls.
        ivec2 start = divide(steep ? d : 2 * d - dx - (dx > 0 ? 1 : 0), 2 * d);
        int k = first - top.y;
        ivec2 rest = divide(slope.y * k + (start.y >> 1), d);
        line = ivec4(top.x + start.x + slope.x * k + rest.x, slope.x, slope.y | (rest.y << 16), d);
    }
    both_edge[edge].z = int(rows | (steep ? 0x80000000u : 0u));
    both_edge[edge].w = int(columns);
    line_edge[edge] = line;
}

void load_tile(uint image, uint tile, ivec2 size, uint chunks) {
    barrier();
    for (uint edge = gl_LocalInvocationID.x; edge < EDGES; edge += RASTER_GROUP) {
        uint part = tile * TILE + (edge >> 2);
        uint corner = edge & 3u;
        if (part < batch.parts) {
            ivec4 x = quads[image * batch.parts + part].x;
            ivec4 y = quads[image * batch.parts + part].y;
            bool drawn = quads[image * batch.parts + part].drawn != 0u;
            uint next = (corner + 1u) & 3u;
            ivec2 p = ivec2(x[corner], y[corner]);
            ivec2 q = ivec2(x[next], y[next]);
            ivec2 last = drawn ? size : ivec2(0);
            set_up_fill(edge, p, q, last.y);
            set_up_line(edge, (p + 128) >> 8, (q + 128) >> 8, last);
            if (corner == 0u) {
                ivec4 px = (x + 128) >> 8;
                ivec4 py = (y + 128) >> 8;
                int left = clamp(min(min(px.x, px.y), min(px.z, px.w)), 0, last.x);
                int right = clamp(max(max(px.x, px.y), max(px.z, px.w)) + 1, 0, last.x);
                int top = clamp(min(min(py.x, py.y), min(py.z, py.w)), 0, last.y);
                int bottom = clamp(max(max(py.x, py.y), max(py.z, py.w)) + 1, 0, last.y);
                part_rows[edge >> 2] = pack_range(top, bottom);
                part_columns[edge >> 2] = pack_range(left, right);
            }
        } else if (corner == 0u) {
            part_rows[edge >> 2] = 0u;
            part_columns[edge >> 2] = 0u;
        }
    }
    barrier();
    for (uint chunk = gl_LocalInvocationID.x; chunk < chunks; chunk += RASTER_GROUP) {
        uint begin = chunk * 32u * CHUNK;
        uint bits = 0u;
        for (uint part = 0u; part < TILE; part++) {
            uint columns = part_columns[part];
            bool reaches = (columns & 0xffffu) < begin + 32u * CHUNK && (columns >> 16) > begin;
            bits |= reaches ? 1u << part : 0u;
        }
        chunk_parts[chunk] = bits;
    }
    barrier();
}

// Sums of the invocation's rows: area of the model, overlap, edges, proximity.
uvec4 rasterise(uint image) {
    Camera camera = cameras[image % batch.views];
    ivec2 size = ivec2(camera.size);
    Bounds box = bounds[image];
    uvec4 sum = uvec4(0u);
    // Nothing to draw: the same for all invocations.
    if (box.low.x >= box.high.x || box.low.y >= box.high.y) return sum;
    uint chunks = (camera.words + CHUNK - 1u) / CHUNK;
    uint tiles = (batch.parts + TILE - 1u) / TILE;
    uint first_chunk = uint(box.low.x) / (32u * CHUNK);
    uint end_chunk = (uint(box.high.x) + 32u * CHUNK - 1u) / (32u * CHUNK);
    bool loaded = false;
    for (int block = box.low.y; block < box.high.y; block += int(RASTER_GROUP)) {
        int y = block + int(gl_LocalInvocationID.x);
        uint row_parts = 0u;
        bool row_known = false;
        for (uint chunk = first_chunk; chunk < end_chunk; chunk++) {
            int origin = int(chunk * 32u * CHUNK);
            uint filled[CHUNK];
            uint edges[CHUNK];
            for (uint word = 0u; word < CHUNK; word++) {
                filled[word] = 0u;
                edges[word] = 0u;
            }
            for (uint tile = 0u; tile < tiles; tile++) {
                if (!loaded || tiles > 1u) {
                    load_tile(image, tile, size, chunks);
                    loaded = true;
                    row_known = false;
                }
                if (!row_known) {
                    row_parts = 0u;
                    uint tile_parts = min(batch.parts - tile * TILE, TILE);
                    for (uint part = 0u; part < tile_parts; part++) {
                        uint rows = part_rows[part];
                        bool reaches = y >= int(rows & 0xffffu) && y < int(rows >> 16);
                        row_parts |= reaches ? 1u << part : 0u;
                    }
                    row_known = true;
                }
                // Nearest parts first, each invocation those of its own row.
                uint parts_left = row_parts & chunk_parts[chunk];
                while (parts_left != 0u) {
                    uint part = uint(findLSB(parts_left));
                    parts_left &= parts_left - 1u;
                    int low = 0x7fffffff;
                    int high = -0x7fffffff;
                    uint lines[CHUNK];
                    for (uint word = 0u; word < CHUNK; word++) lines[word] = 0u;
                    for (uint corner = 0u; corner < 4u; corner++) {
                        ivec4 fill = fill_edge[4u * part + corner];
                        ivec4 both = both_edge[4u * part + corner];
                        ivec4 line = line_edge[4u * part + corner];
                        int fill_first = fill.x & 0xffff;
                        int fill_end = int(uint(fill.x) >> 16);
                        int k = y - fill_first;
                        int crossing = fill.y + k * fill.z + step_to(k, fill.w, both.y, both.x).x;
                        bool crosses = k >= 0 && y < fill_end;
                        low = crosses ? min(low, crossing) : low;
                        high = crosses ? max(high, crossing) : high;

                        int line_first = both.z & 0xffff;
                        int line_end = (both.z >> 16) & 0x7fff;
                        k = y - line_first;
                        int t = line.z & 0xffff;
                        ivec2 at = step_to(k, t, int(uint(line.z) >> 16), line.w);
                        int begin = line.x + k * line.y + at.x;
                        int next = begin + (both.z < 0 ? 1 : line.y + (at.y + t >= line.w ? 1 : 0));
                        int from = max(min(begin, next), both.w & 0xffff);
                        int to = min(max(begin, next), int(uint(both.w) >> 16));
                        to = k >= 0 && y < line_end ? to : from;
                        for (uint word = 0u; word < CHUNK; word++) {
                            int start = origin + int(32u * word);
                            lines[word] |= span_bits(from - start, to - start);
                        }
                    }
                    for (uint word = 0u; word < CHUNK; word++) {
                        int start = origin + int(32u * word);
                        edges[word] |= lines[word] & ~filled[word];
                        filled[word] |= span_bits(max(low, origin) - start, min(high, size.x) - start);
                    }
                }
            }
            for (uint word = 0u; word < CHUNK; word++) {
                uint drawn = filled[word] | edges[word];
                if (drawn != 0u) {
                    uint group = camera.first_plane_word + uint(y) * camera.words + chunk * CHUNK + word;
                    uvec4 near = planes[2u * group];
                    uvec4 far = planes[2u * group + 1u];
                    uvec4 ones = uvec4(1u, 2u, 4u, 8u) * uvec4(bitCount(near & edges[word]));
                    uvec3 sixteens = uvec3(16u, 32u, 64u) * uvec3(bitCount(far.xyz & edges[word]));
                    sum.x += uint(bitCount(drawn));
                    sum.y += uint(bitCount(drawn & far.w));
                    sum.z += uint(bitCount(edges[word]));
                    sum.w += ones.x + ones.y + ones.z + ones.w + sixteens.x + sixteens.y + sixteens.z;
                }
            }
        }
    }
    return sum;
}

uint own_image() {
    return LISTED ? list[3u + gl_WorkGroupID.x] : gl_WorkGroupID.x;
}

void write_sums(uint image, uvec4 sum) {
    sums[batch.first * batch.views + image] = Sums(sum.x, sum.y, sum.z, sum.w);
}
