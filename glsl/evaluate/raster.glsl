// Drawing and comparison without any framebuffer (docs/RASTER.md, METHOD A6): the whole of both compute variants but for how a
// workgroup sums. A workgroup takes an image, an invocation a row. A chunk of the row is two sets of bits kept in registers, what
// fills cover and where borders show; the observation is bit planes, so everything counted is a bit count. What an edge costs once is
// found in every row where reading memory costs more than that, or by the workgroup, an invocation an edge, and kept.

#define SUMMED writeonly

#include "evaluate/batch.glsl"
#include "evaluate/raster_counts.glsl"
#include "evaluate/spans.glsl"

layout(local_size_x = RASTER_GROUP, local_size_x_id = 2) in;

// Whether the images are those of the list, not all of the batch.
layout(constant_id = 0) const bool LISTED = false;
// Words of a row that are drawn at once, at most MOST_RASTER_WORDS.
layout(constant_id = 3) const uint WORDS = RASTER_WORDS;
// Whether the workgroup keeps edges, and of how many parts: RASTER_PARTS, or 1 where it keeps none.
layout(constant_id = 6) const bool KEEPS_EDGES = false;
layout(constant_id = 7) const uint EDGES_KEPT = 1u;

layout(std430, set = 0, binding = 1) readonly buffer Quads { Quad quads[]; };
// Three words of a dispatch, then image numbers.
layout(std430, set = 0, binding = 4) readonly buffer List { uint list[]; };

const uint TILE = RASTER_PARTS;
// Chunks of the widest picture, of a word each.
const uint MOST_CHUNKS = (LARGEST_SIDE + 31u) / 32u;

// Corners of the parts of the tile, 1/256 pixel; or their edges and lines.
shared ivec4 part_x[TILE];
shared ivec4 part_y[TILE];
shared Edges part_edges[EDGES_KEPT];
shared Lines part_lines[EDGES_KEPT];
// Rows and columns that a part may touch, first and past the last in 16 bits each, and for each chunk one bit a part that
// reaches into it.
shared uvec4 part_rows[TILE / 4u];
shared uint part_columns[TILE];
#if defined(SEGMENTED) || defined(EVIDENCE)
// The segment, or the class.
shared uint part_numbers[TILE];
#endif
shared uint chunk_parts[MOST_CHUNKS];

// The edges of the parts of a tile, an invocation one.
void keep_edges(uint image, uint tile) {
    uint from = image * batch.parts + tile * TILE;
    uint count = 4u * min(batch.parts - tile * TILE, TILE);
    for (uint own = gl_LocalInvocationID.x; own < count; own += gl_WorkGroupSize.x) {
        uint slot = own / 4u;
        uint corner = own % 4u;
        uint next = (corner + 1u) % 4u;
        ivec2 begin = ivec2(quads[from + slot].x[corner], quads[from + slot].y[corner]);
        ivec2 end = ivec2(quads[from + slot].x[next], quads[from + slot].y[next]);
        Edge edge = edge_between(begin, end);
        part_edges[slot].top_x[corner] = edge.top.x;
        part_edges[slot].top_y[corner] = edge.top.y;
        part_edges[slot].dx[corner] = edge.delta.x;
        part_edges[slot].dy[corner] = edge.delta.y;
        part_edges[slot].inverse[corner] = edge.inverse;
        begin = (begin + 128) >> 8;
        end = (end + 128) >> 8;
        edge = edge_between(begin, end);
        part_lines[slot].edge.top_x[corner] = edge.top.x;
        part_lines[slot].edge.top_y[corner] = edge.top.y;
        part_lines[slot].edge.dx[corner] = edge.delta.x;
        part_lines[slot].edge.dy[corner] = edge.delta.y;
        part_lines[slot].edge.inverse[corner] = edge.inverse;
        part_lines[slot].start[corner] = line_start(edge.delta);
        part_lines[slot].left[corner] = min(begin.x, end.x);
        part_lines[slot].right[corner] = max(begin.x, end.x) + 1;
    }
}

void load_tile(uint image, uint tile, ivec2 size, uint chunks) {
    uint words = WORDS;
    barrier();
    if (KEEPS_EDGES) keep_edges(image, tile);
    for (uint slot = gl_LocalInvocationID.x; slot < TILE; slot += gl_WorkGroupSize.x) {
        uint part = tile * TILE + slot;
        uint rows = 0u;
        uint columns = 0u;
        if (part < batch.parts) {
            ivec4 x = quads[image * batch.parts + part].x;
            ivec4 y = quads[image * batch.parts + part].y;
            part_x[slot] = x;
#ifdef SEGMENTED
            part_numbers[slot] = table.numbers[quads[image * batch.parts + part].label & (LABELS - 1u)];
#endif
#ifdef EVIDENCE
            part_numbers[slot] = table.classes[quads[image * batch.parts + part].label & (LABELS - 1u)];
#endif
            part_y[slot] = y;
            if (quads[image * batch.parts + part].drawn != 0u) {
                rows = touched(y, 0, size.y);
                columns = touched(x, 0, size.x);
            }
        }
        part_rows[slot >> 2][slot & 3u] = rows;
        part_columns[slot] = columns;
    }
    barrier();
    for (uint chunk = gl_LocalInvocationID.x; chunk < chunks; chunk += gl_WorkGroupSize.x) {
        uint begin = chunk * 32u * words;
        uint bits = 0u;
        for (uint part = 0u; part < TILE; part++) {
            uint columns = part_columns[part];
            bool reaches = (columns & 0xffffu) < begin + 32u * words && (columns >> 16) > begin;
            bits |= reaches ? 1u << part : 0u;
        }
        chunk_parts[chunk] = bits;
    }
    barrier();
}

// Sums of the invocation's rows: area of the model, overlap, edges, proximity.
uvec4 rasterise(uint image) {
    uint words = WORDS;
    Camera camera = cameras[image % batch.views];
    ivec2 size = ivec2(camera.size);
    Bounds box = bounds[image];
    uvec4 sum = uvec4(0u);
    // Nothing to draw: the same for all invocations.
    if (box.low.x >= box.high.x || box.low.y >= box.high.y) return sum;
    uint chunks = (camera.words + words - 1u) / words;
    uint tiles = (batch.parts + TILE - 1u) / TILE;
    uint first_chunk = uint(box.low.x) / (32u * words);
    uint end_chunk = (uint(box.high.x) + 32u * words - 1u) / (32u * words);
    bool loaded = false;
    uint group_rows = gl_WorkGroupSize.x;
    for (int block = box.low.y; block < box.high.y; block += int(group_rows)) {
        int y = block + int(gl_LocalInvocationID.x);
        uint row_parts = 0u;
        bool row_known = false;
        for (uint chunk = first_chunk; chunk < end_chunk; chunk++) {
            int origin = int(chunk * 32u * words);
            uint filled[MOST_RASTER_WORDS];
            uint edges[MOST_RASTER_WORDS];
            for (uint word = 0u; word < words; word++) {
                filled[word] = 0u;
                edges[word] = 0u;
            }
#ifdef SEGMENTED
            // The segment number of every pixel, a bit plane a component.
            uvec4 shown[MOST_RASTER_WORDS];
            for (uint word = 0u; word < words; word++) shown[word] = uvec4(0u);
#endif
            for (uint tile = 0u; tile < tiles; tile++) {
                if (!loaded || tiles > 1u) {
                    load_tile(image, tile, size, chunks);
                    loaded = true;
                    row_known = false;
                }
                if (!row_known) {
                    row_parts = 0u;
                    uint tile_parts = min(batch.parts - tile * TILE, TILE);
                    for (uint part = 0u; part < tile_parts; part += 4u) {
                        uvec4 rows = part_rows[part >> 2];
                        uvec4 bits = uvec4(1u, 2u, 4u, 8u);
                        bits = mix(uvec4(0u), bits, greaterThanEqual(uvec4(y), rows & 0xffffu));
                        bits = mix(uvec4(0u), bits, lessThan(uvec4(y), rows >> 16));
                        row_parts |= (bits.x | bits.y | bits.z | bits.w) << part;
                    }
                    row_known = true;
                }
                // Nearest parts first, each invocation those of its own row.
                uint parts_left = row_parts & chunk_parts[chunk];
                while (parts_left != 0u) {
                    uint part = uint(findLSB(parts_left));
                    parts_left &= parts_left - 1u;
                    ivec2 fill;
                    ivec4 from;
                    ivec4 to;
                    if (KEEPS_EDGES) {
                        fill = fill_span(part_edges[part], y);
                        line_spans(part_lines[part], y, from, to);
                    } else {
                        ivec4 x = part_x[part];
                        ivec4 y_corners = part_y[part];
                        fill = fill_span(edges_between(x, y_corners), y);
                        line_spans(lines_between((x + 128) >> 8, (y_corners + 128) >> 8), y, from, to);
                    }
                    for (uint word = 0u; word < words; word++) {
                        int start = origin + int(32u * word);
                        uint lines = span_bits(from.x - start, to.x - start) | span_bits(from.y - start, to.y - start) |
                            span_bits(from.z - start, to.z - start) | span_bits(from.w - start, to.w - start);
                        uint inner = span_bits(fill.x - start, fill.y - start);
#ifdef SEGMENTED
                        uint nearest = (lines | inner) & ~(filled[word] | edges[word]);
                        shown[word] |= number_bits(part_numbers[part]) & nearest;
#endif
#ifdef EVIDENCE
                        // Parts come from the nearest on: what one shows is its own for good.
                        uint own = (lines | inner) & ~(filled[word] | edges[word]) & below(size.x - start);
                        if (own != 0u) {
                            uint group = camera.first_plane_word + uint(y) * camera.words + chunk * words + word;
                            count_codes(group, part_numbers[part], own);
                        }
#endif
                        edges[word] |= lines & ~filled[word];
                        filled[word] |= inner;
                    }
                }
            }
            for (uint word = 0u; word < words; word++) {
                uint group = camera.first_plane_word + uint(y) * camera.words + chunk * words + word;
                uint inside = counting(size.x - origin - int(32u * word), group);
                uint drawn = (filled[word] | edges[word]) & inside;
#ifdef SEGMENTED
                count_drawn(sum, group, drawn, edges[word] & inside, shown[word]);
#else
                count_drawn(sum, group, drawn, edges[word] & inside);
#endif
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
