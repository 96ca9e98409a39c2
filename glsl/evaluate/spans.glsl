// Which pixels of a row a part covers, fill and border (docs/RASTER.md), in closed form: what an edge costs once is apart from what it
// costs a row.
//
// Bounds of spans are exact in 32-bit arithmetic, whatever the products do: a bound is estimated in floating point, off by one at
// most, and what is left over, which always fits 32 bits although its terms do not, says which way.

// First and past the last in 16 bits each, 0 where there is none.
uint pack_range(int first, int end) {
    return first < end ? uint(first) | (uint(end) << 16) : 0u;
}

// Pixels from `low` on to before `high` that corners along an axis may touch.
uint touched(ivec4 corners, int low, int high) {
    corners = (corners + 128) >> 8;
    int first = min(min(corners.x, corners.y), min(corners.z, corners.w));
    int last = max(max(corners.x, corners.y), max(corners.z, corners.w));
    return pack_range(clamp(first, low, high), clamp(last + 1, low, high));
}

// Bits of the pixels from `low` on to before `high`, of a word that begins at 0.
uint span_bits(int low, int high) {
    int first = max(low, 0);
    int end = min(high, 32);
    return first < end ? (0xffffffffu << uint(first)) & (0xffffffffu >> uint(32 - end)) : 0u;
}

// 1 where true.
ivec4 count(bvec4 condition) {
    return mix(ivec4(0), ivec4(1), condition);
}

// Four edges from their upper ends: x there, and how far the lower ends are.
struct Edges {
    ivec4 top_x;
    ivec4 top_y;
    ivec4 dx;
    ivec4 dy;
    vec4 inverse; // of dy
};

Edges edges_between(ivec4 x, ivec4 y) {
    ivec4 next_x = x.yzwx;
    ivec4 next_y = y.yzwx;
    bvec4 down = lessThanEqual(y, next_y);
    ivec4 top_x = mix(next_x, x, down);
    ivec4 dy = abs(next_y - y);
    return Edges(top_x, min(y, next_y), mix(x, next_x, down) - top_x, dy, 1.0 / vec4(max(dy, 1)));
}

// One of them.
struct Edge {
    ivec2 top;
    ivec2 delta;
    float inverse; // of delta.y
};

Edge edge_between(ivec2 from, ivec2 to) {
    bool down = from.y <= to.y;
    ivec2 top = down ? from : to;
    ivec2 delta = (down ? to : from) - top;
    return Edge(top, delta, 1.0 / float(max(delta.y, 1)));
}

// Fill: in row y the part covers the pixels from x on to before y of the result, none when they are not in order. An edge is
// crossed at X = top + dx m / dy, and its bound is the first pixel c with 256 c >= X. Corners are in 1/256 pixel.
ivec2 fill_span(Edges edge, int row) {
    ivec4 m = 256 * row - edge.top_y;
    // At most 5 units off, of the 2^22 that a corner may be away; 8 are allowed for.
    vec4 crossing = vec4(edge.top_x) + vec4(edge.dx) * vec4(m) * edge.inverse;
    ivec4 bound = ivec4(ceil(crossing * (1.0 / 256.0)));
    // (256 c - X) dy, which is to be from 0 to 256 dy, with 8 dy added: below 2^32.
    uvec4 rest = uvec4((256 * bound - edge.top_x) * edge.dy - edge.dx * m + 8 * edge.dy);
    bound += count(lessThan(rest, uvec4(8 * edge.dy))) - count(greaterThanEqual(rest, 264u * uvec4(edge.dy)));
    // No edge is crossed by a row above or below it, nor a level one.
    bvec4 crosses = lessThan(uvec4(m), uvec4(edge.dy));
    ivec4 low = mix(ivec4(0x7fffffff), bound, crosses);
    ivec4 high = mix(ivec4(-0x7fffffff), bound, crosses);
    return ivec2(min(min(low.x, low.y), min(low.z, low.w)), max(max(high.x, high.y), max(high.z, high.w)));
}

// The four lines of a border, between whole pixels.
struct Lines {
    Edges edge;
    ivec4 start; // of the numerators
    ivec4 left;
    ivec4 right; // past the last
};

// The start of a line's numerators, as `lines_between` has it.
int line_start(ivec2 delta) {
    bool steep = delta.y > abs(delta.x);
    return steep ? delta.y : 2 * max(delta.y, 1) - delta.x - (delta.x > 0 ? 1 : 0);
}

Lines lines_between(ivec4 x, ivec4 y) {
    Edges edge = edges_between(x, y);
    bvec4 steep = greaterThan(edge.dy, abs(edge.dx));
    // Steep: the nearest column, a tie to the larger. Flat: the columns whose nearest row this is begin at the ceiling of the
    // crossing with row - 1/2 when x grows with the row, and end after its floor when x falls; then the next row goes on.
    ivec4 start = mix(max(edge.dy, 1) * 2 - edge.dx - count(greaterThan(edge.dx, ivec4(0))), edge.dy, steep);
    return Lines(edge, start, min(x, x.yzwx), max(x, x.yzwx) + 1);
}

// floor(numerator / d) for d > 0, where the numerator may have wrapped and `estimate` is about the quotient.
ivec4 floor_divide(ivec4 numerator, vec4 estimate, ivec4 d) {
    ivec4 quotient = ivec4(floor(estimate));
    ivec4 rest = numerator - quotient * d;
    return quotient + count(greaterThanEqual(rest, d)) - count(lessThan(rest, ivec4(0)));
}

// In row y the four lines cover the pixels from `from` on to before `to`.
void line_spans(Lines lines, int row, out ivec4 from, out ivec4 to) {
    Edges edge = lines.edge;
    ivec4 k = row - edge.top_y;
    ivec4 d = 2 * max(edge.dy, 1);
    ivec4 numerator = 2 * edge.dx * k + lines.start;
    vec4 inverse = 0.5 * edge.inverse;
    vec4 wide = 2.0 * vec4(edge.dx) * vec4(k) + vec4(lines.start);
    ivec4 begin = edge.top_x + floor_divide(numerator, wide * inverse, d);
    ivec4 after = edge.top_x + floor_divide(numerator + 2 * edge.dx, (wide + 2.0 * vec4(edge.dx)) * inverse, d);
    after = mix(after, begin + 1, greaterThan(edge.dy, abs(edge.dx)));
    bvec4 level = equal(edge.dy, ivec4(0));
    from = mix(max(min(begin, after), lines.left), lines.left, level);
    to = mix(min(max(begin, after), lines.right), lines.right, level);
    to = mix(from, to, lessThanEqual(uvec4(k), uvec4(edge.dy)));
}
