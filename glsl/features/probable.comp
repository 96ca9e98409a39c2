#version 450
#extension GL_GOOGLE_include_directive : require

// The colours of the most probable components, of every so many rows and columns.

#include "features/constants.glsl"
#include "arithmetic/rounding.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer State { float state[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Background { uint background[]; };

layout(push_constant) uniform Probable {
    uint width;
    uint rows;      // of the band
    uint first_row; // a multiple of `every`
    uint every;     // rows and columns
} push;

layout(constant_id = 0) const uint COMPONENTS = 3u;

// To the nearest whole number, halves up, within 0 to 255.
uint rounded(float value) {
    float down = floor(value);
    float up = value - down >= 0.5 ? down + 1.0 : down;
    return uint(clamp(up, 0.0, 255.0));
}

void main() {
    uint components = COMPONENTS;
    uint columns = (push.width + push.every - 1u) / push.every;
    uint column = gl_GlobalInvocationID.x;
    uint row = gl_GlobalInvocationID.y * push.every;
    if (column >= columns || row >= push.rows) return;
    uint pixels = push.width * push.rows;
    uint pixel = row * push.width + column * push.every;
    float greatest = -1.0;
    uint colour = 0u;
    for (uint k = 0u; k < components; k++) {
        uint at = k * MIXTURE_FIELDS * pixels + pixel;
        float weight = state[at];
        precise float squared = weight * weight;
        float rank = quotient(squared, state[at + 4u * pixels]);
        if (rank > greatest) {
            greatest = rank;
            colour = rounded(state[at + pixels]) | (rounded(state[at + 2u * pixels]) << 8u) | (rounded(state[at + 3u * pixels]) << 16u);
        }
    }
    background[(push.first_row + row) / push.every * columns + column] = colour;
}
