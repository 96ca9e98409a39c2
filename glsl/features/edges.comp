#version 450
#extension GL_GOOGLE_include_directive : require

// Edges among the pixels near the silhouette (METHOD A5.2): gradients of at least the threshold, or zero crossings.

#include "features/gradient.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 1) readonly buffer Near { uint near[]; };
layout(std430, set = 0, binding = 2) writeonly buffer Edges { uint edges[]; };

// The form of the operator's masks, and its weights at corners, sides and in the middle, or across outer ones, none and a middle one:
// src/features/edges/mod.rs.
layout(constant_id = 0) const uint FORM = 0u;
layout(constant_id = 1) const uint MAGNITUDE = 0u;
layout(constant_id = 2) const int CORNER = 1;
layout(constant_id = 3) const int SIDE = 0;
layout(constant_id = 4) const int MIDDLE = 2;

shared uint words[2];

bool is_strong(ivec2 g, uint magnitude) {
    return order(g, magnitude) >= order_of(picture.amount, magnitude);
}

int response(int x, int y, ivec3 weights) {
    int sides = at(x, y - 1) + at(x, y + 1) + at(x - 1, y) + at(x + 1, y);
    int response = weights.y * sides + weights.z * at(x, y);
    if (weights.x == 0) return response;
    int corners = at(x - 1, y - 1) + at(x + 1, y - 1) + at(x - 1, y + 1) + at(x + 1, y + 1);
    return response + weights.x * corners;
}

bool jumps(int a, int b) {
    return a * b < 0 && abs(a - b) >= picture.amount;
}

// As the library's: of two neighbours the one nearer to zero, of equal ones the left or upper; a zero between two opposites.
bool crosses_zero(int x, int y, ivec3 weights) {
    int here = response(x, y, weights);
    bool has_left = x > 0;
    bool has_right = x + 1 < int(picture.width);
    bool has_up = y > 0;
    bool has_down = y + 1 < int(picture.height);
    int left = response(x - 1, y, weights);
    int right = response(x + 1, y, weights);
    int up = response(x, y - 1, weights);
    int down = response(x, y + 1, weights);
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
    uint form = FORM;
    ivec3 weights = ivec3(CORNER, SIDE, MIDDLE);
    uint magnitude = MAGNITUDE;
    uint place = uint(y) * picture.stride + (uint(x) >> 5u);
    if (lane < 2u) words[lane] = 0u;
    barrier();
    // The stride is a whole number of workgroups, so the word is there even where the pixel is not.
    bool wanted = x < int(picture.width) && ((near[place] >> (uint(x) & 31u)) & 1u) != 0u;
    if (wanted) {
        bool found = false;
        if (form == EDGES_ACROSS) {
            found = is_strong(separable(x, y, weights.x, weights.z), magnitude);
        } else if (form == EDGES_DIAGONALS) {
            found = is_strong(ivec2(at(x, y) - at(x + 1, y + 1), at(x + 1, y) - at(x, y + 1)), magnitude);
        } else {
            found = crosses_zero(x, y, weights);
        }
        if (found) atomicOr(words[lane >> 5u], 1u << (lane & 31u));
    }
    barrier();
    if ((lane & 31u) == 0u) edges[place] = words[lane >> 5u];
}
