// Drawing and comparison without any framebuffer in two phases (docs/RASTER.md, METHOD A6): the spans of every part in every row of a
// strip go to shared memory, some rows of a part an invocation; then an invocation takes 32 pixels of a row and merges the parts there,
// the nearest first. Some workgroups share the strips of an image.
//
// `raster.glsl` has an invocation do both for a row: it computes a span where it needs it, and waits while others of its subgroup
// do. Here no invocation waits for another but at barriers, and neighbours merge the same parts.

#define SUMMED

#include "evaluate/batch.glsl"
#include "evaluate/raster_counts.glsl"
#include "evaluate/spans.glsl"

layout(local_size_x = 64, local_size_x_id = 2) in;

layout(std430, set = 0, binding = 1) readonly buffer Quads { Quad quads[]; };

// Parts whose spans are kept at once, and rows of a strip.
const uint TILE = 16u;
const uint STRIP = 32u;
// Rows of a part that an invocation takes at once: what an edge costs once is shared by them.
const uint RUN = 4u;
// Spans of a part in a row: its fill and four lines.
const uint SPANS = 5u;
const uint MOST_WORDS = (LARGEST_SIDE + 31u) / 32u;

shared uint spans[TILE * STRIP * SPANS];
// One bit a part, of those in a row and those that reach into 32 columns.
shared uint row_parts[STRIP];
shared uint word_parts[MOST_WORDS];
// Rows of the strip and columns that a part may touch.
shared uint part_rows[TILE];
shared uint part_columns[TILE];
// Runs of a part and of all before it.
shared uint run_ends[TILE];
#if defined(SEGMENTED) || defined(EVIDENCE)
// The segment, or the class.
shared uint part_numbers[TILE];
#endif

// The rows of a strip from `top` on, with the bits of the words from `first` on to before `end`.
void find_spans(uint image, uint tile, ivec2 rows, uvec2 words, int width) {
    uint own = gl_LocalInvocationID.x;
    uint from = image * batch.parts + tile * TILE;
    barrier();
    for (uint slot = own; slot < TILE; slot += gl_WorkGroupSize.x) {
        part_rows[slot] = 0u;
        part_columns[slot] = 0u;
        if (tile * TILE + slot < batch.parts && quads[from + slot].drawn != 0u) {
            uint touches = touched(quads[from + slot].y, rows.x, rows.y);
            part_columns[slot] = touched(quads[from + slot].x, 0, width);
            part_rows[slot] = part_columns[slot] != 0u ? touches : 0u;
#ifdef SEGMENTED
            part_numbers[slot] = table.numbers[quads[from + slot].label & (LABELS - 1u)];
#endif
#ifdef EVIDENCE
            part_numbers[slot] = table.classes[quads[from + slot].label & (LABELS - 1u)];
#endif
        }
    }
    for (uint row = own; row < STRIP; row += gl_WorkGroupSize.x) row_parts[row] = 0u;
    barrier();
    for (uint slot = own; slot < TILE; slot += gl_WorkGroupSize.x) {
        uint runs = 0u;
        for (uint part = 0u; part <= slot; part++) {
            runs += ((part_rows[part] >> 16) - (part_rows[part] & 0xffffu) + RUN - 1u) / RUN;
        }
        run_ends[slot] = runs;
    }
    for (uint word = words.x + own; word < words.y; word += gl_WorkGroupSize.x) {
        uint bits = 0u;
        for (uint part = 0u; part < TILE; part++) {
            uint columns = part_columns[part];
            bool reaches = (columns & 0xffffu) < 32u * word + 32u && (columns >> 16) > 32u * word;
            bits |= reaches ? 1u << part : 0u;
        }
        word_parts[word] = bits;
    }
    barrier();
    for (uint run = own; run < run_ends[TILE - 1u]; run += gl_WorkGroupSize.x) {
        // The first part whose runs end past it.
        uint part = 0u;
        for (uint step = TILE / 2u; step > 0u; step >>= 1) part += run_ends[part + step - 1u] <= run ? step : 0u;
        uint before = part > 0u ? run_ends[part - 1u] : 0u;
        int begin = int((part_rows[part] & 0xffffu) + RUN * (run - before));
        int end = min(begin + int(RUN), int(part_rows[part] >> 16));
        ivec4 x = quads[from + part].x;
        ivec4 y = quads[from + part].y;
        Edges edges = edges_between(x, y);
        Lines lines = lines_between((x + 128) >> 8, (y + 128) >> 8);
        for (int row = begin; row < end; row++) {
            ivec2 fill = clamp(fill_span(edges, row), 0, width);
            ivec4 low;
            ivec4 high;
            line_spans(lines, row, low, high);
            low = clamp(low, 0, width);
            high = clamp(high, 0, width);
            uint place = (part * STRIP + uint(row - rows.x)) * SPANS;
            spans[place] = pack_range(fill.x, fill.y);
            for (uint line = 0u; line < 4u; line++) spans[place + 1u + line] = pack_range(low[line], high[line]);
            atomicOr(row_parts[row - rows.x], 1u << part);
        }
    }
    barrier();
}

// The pixels of a packed span in the word that begins at column `start`.
uint bits_of(uint span, int start) {
    return span_bits(int(span & 0xffffu) - start, int(span >> 16) - start);
}

// Sums of the invocation's pixels: area of the model, overlap, edges, proximity.
uvec4 rasterise(uint image) {
    Camera camera = cameras[image % batch.views];
    Bounds box = bounds[image];
    uvec4 sum = uvec4(0u);
    // Nothing to draw: the same for all invocations.
    if (box.low.x >= box.high.x || box.low.y >= box.high.y) return sum;
    int width = int(camera.size.x);
    uvec2 words = uvec2(uint(box.low.x) / 32u, (uint(box.high.x) + 31u) / 32u);
    uint abreast = words.y - words.x;
    uint tiles = (batch.parts + TILE - 1u) / TILE;
    int stride = int(STRIP * gl_NumWorkGroups.y);
    for (int top = box.low.y + int(STRIP * gl_WorkGroupID.y); top < box.high.y; top += stride) {
        ivec2 rows = ivec2(top, min(top + int(STRIP), box.high.y));
        uint count = uint(rows.y - rows.x) * abreast;
        for (uint block = 0u; block < count; block += gl_WorkGroupSize.x) {
            uint item = block + gl_LocalInvocationID.x;
            bool is_there = item < count;
            uint row = is_there ? item / abreast : 0u;
            uint word = words.x + (is_there ? item - row * abreast : 0u);
            int start = int(32u * word);
            uint group = camera.first_plane_word + uint(rows.x + int(row)) * camera.words + word;
            uint filled = 0u;
            uint edges = 0u;
#ifdef SEGMENTED
            // The segment number of every pixel, a bit plane a component.
            uvec4 shown = uvec4(0u);
#endif
            for (uint tile = 0u; tile < tiles; tile++) {
                // Those of the only tile stay.
                if (block == 0u || tiles > 1u) find_spans(image, tile, rows, words, width);
                uint parts_left = is_there ? row_parts[row] & word_parts[word] : 0u;
                while (parts_left != 0u) {
                    uint part = uint(findLSB(parts_left));
                    parts_left &= parts_left - 1u;
                    uint place = (part * STRIP + row) * SPANS;
                    uint inner = bits_of(spans[place], start);
                    uint lines = bits_of(spans[place + 1u], start) | bits_of(spans[place + 2u], start) |
                        bits_of(spans[place + 3u], start) | bits_of(spans[place + 4u], start);
#ifdef SEGMENTED
                    shown |= number_bits(part_numbers[part]) & ((lines | inner) & ~(filled | edges));
#endif
#ifdef EVIDENCE
                    // Parts come from the nearest on: what one shows is its own for good.
                    uint shows = (lines | inner) & ~(filled | edges);
                    if (shows != 0u) count_codes(group, part_numbers[part], shows);
#endif
                    edges |= lines & ~filled;
                    filled |= inner;
                }
            }
            if (!is_there) continue;
            uint inside = counting(width - start, group);
            uint drawn = (filled | edges) & inside;
#ifdef SEGMENTED
            count_drawn(sum, group, drawn, edges & inside, shown);
#else
            count_drawn(sum, group, drawn, edges & inside);
#endif
        }
    }
    return sum;
}
