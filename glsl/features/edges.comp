#version 450
#extension GL_GOOGLE_include_directive : require

// Edges among the pixels near the silhouette (METHOD A5.2): gradients of at least the threshold, or zero crossings.

#include "features/gradient.glsl"

// Places in the list of operators, src/features/edges/mod.rs.
const uint EDGES_SOBEL = 0u;
const uint EDGES_PREWITT = 1u;
const uint EDGES_ROBERTS = 2u;
const uint EDGES_LAPLACE_FOUR = 3u;
const uint EDGES_LAPLACE_EIGHT = 4u;
const uint EDGES_LAPLACE_PRODUCT = 5u;

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 1) readonly buffer Near { uint near[]; };
layout(std430, set = 0, binding = 2) writeonly buffer Edges { uint edges[]; };

layout(constant_id = 0) const uint OPERATOR = 0u;
layout(constant_id = 1) const uint MAGNITUDE = 0u;

shared uint words[2];

bool is_strong(ivec2 g, uint magnitude) {
    return order(g, magnitude) >= order_of(picture.amount, magnitude);
}

int response(int x, int y, uint mask) {
    int sides = at(x, y - 1) + at(x, y + 1) + at(x - 1, y) + at(x + 1, y);
    if (mask == EDGES_LAPLACE_FOUR) return sides - 4 * at(x, y);
    int corners = at(x - 1, y - 1) + at(x + 1, y - 1) + at(x - 1, y + 1) + at(x + 1, y + 1);
    if (mask == EDGES_LAPLACE_EIGHT) return sides + corners - 8 * at(x, y);
    return corners - 2 * sides + 4 * at(x, y);
}

bool jumps(int a, int b) {
    return a * b < 0 && abs(a - b) >= picture.amount;
}

// As the library's: of two neighbours the one nearer to zero, of equal ones the left or upper; a zero between two opposites.
bool crosses_zero(int x, int y, uint mask) {
    int here = response(x, y, mask);
    bool has_left = x > 0;
    bool has_right = x + 1 < int(picture.width);
    bool has_up = y > 0;
    bool has_down = y + 1 < int(picture.height);
    int left = response(x - 1, y, mask);
    int right = response(x + 1, y, mask);
    int up = response(x, y - 1, mask);
    int down = response(x, y + 1, mask);
    if (here == 0) return (has_left && has_right && jumps(left, right)) || (has_up && has_down && jumps(up, down));
    bool before = (has_left && jumps(here, left) && abs(here) < abs(left)) || (has_up && jumps(here, up) && abs(here) < abs(up));
    bool after = (has_right && jumps(here, right) && abs(here) <= abs(right))
        || (has_down && jumps(here, down) && abs(here) <= abs(down));
    return before || after;
}

void main() {
    uint lane = gl_LocalInvocationID.x;
    int x = int(gl_GlobalInvocationID.x);
    int y = int(gl_GlobalInvocationID.y);
    uint operator_ = OPERATOR;
    uint magnitude = MAGNITUDE;
    uint place = uint(y) * picture.stride + (uint(x) >> 5u);
    if (lane < 2u) words[lane] = 0u;
    barrier();
    // The stride is a whole number of workgroups, so the word is there even where the pixel is not.
    bool wanted = x < int(picture.width) && ((near[place] >> (uint(x) & 31u)) & 1u) != 0u;
    if (wanted) {
        bool found = false;
        if (operator_ == EDGES_SOBEL) {
            found = is_strong(separable(x, y, 2), magnitude);
        } else if (operator_ == EDGES_PREWITT) {
            found = is_strong(separable(x, y, 1), magnitude);
        } else if (operator_ == EDGES_ROBERTS) {
            found = is_strong(ivec2(at(x, y) - at(x + 1, y + 1), at(x + 1, y) - at(x, y + 1)), magnitude);
        } else {
            found = crosses_zero(x, y, operator_);
        }
        if (found) atomicOr(words[lane >> 5u], 1u << (lane & 31u));
    }
    barrier();
    if ((lane & 31u) == 0u) edges[place] = words[lane >> 5u];
}
