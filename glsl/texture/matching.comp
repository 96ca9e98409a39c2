#version 450
#extension GL_GOOGLE_include_directive : require

// The sum of squared errors over the known pixels of a region, for every placement of it within the example (METHOD B3): an
// invocation a placement, operations in the order of texture/example/matching.rs, `precise`, so that the sums are its bits.

layout(local_size_x = 64) in;

// Colours as errors measure them; w unused.
layout(std430, set = 0, binding = 0) readonly buffer Example { vec4 example[]; };
// Of each known pixel: where it lies from the placement's first pixel, as bits, and its colour.
layout(std430, set = 0, binding = 1) readonly buffer KnownPixels { vec4 known[]; };
// What the squared error of each counts.
layout(std430, set = 0, binding = 2) readonly buffer KnownWeights { float weights[]; };
layout(std430, set = 0, binding = 3) readonly buffer Request {
    uint groups[3]; // of this stage: what an indirect dispatch reads
    uint width;     // of the example
    uint columns;   // placements across
    uint placements;
    uint known_count;
} request;
layout(std430, set = 0, binding = 4) writeonly buffer Errors { float errors[]; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= request.placements) return;
    uint first = i / request.columns * request.width + i % request.columns;
    precise float sum = 0.0;
    for (uint k = 0u; k < request.known_count; k++) {
        vec4 pixel = known[k];
        vec3 texel = example[first + floatBitsToUint(pixel.x)].rgb;
        precise vec3 difference = texel - pixel.yzw;
        precise vec3 square = weights[k] * (difference * difference);
        sum = sum + square.x;
        sum = sum + square.y;
        sum = sum + square.z;
    }
    errors[i] = sum;
}
