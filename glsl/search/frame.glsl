// What differs from frame to frame, and the random numbers of a frame.

#include "search/philox.glsl"

layout(std430, set = SEARCH_SET, binding = 0) readonly buffer Frame {
    uint number;
    uint goes_on;   // 1 where the filter resamples its particles, 0 where it puts all of them on the centre
    uvec2 seed;     // low word, high word
    float values[]; // rows of centre, spread, lower and upper limits
} frame;

uvec4 random_words(uint iteration, uint particle, uint draw, uint block) {
    return philox(uvec4(particle, draw << 24 | block, iteration, frame.number), frame.seed);
}

// The lower and the upper limit of a degree of freedom.
vec2 limits_of(uint d, uint dofs) {
    return vec2(frame.values[2u * dofs + d], frame.values[3u * dofs + d]);
}

// A normal step from `from` with `factor` times the frame's spread, held within the limits.
float scattered(float from, float normal, float factor, uint d, uint dofs) {
    precise float spread = frame.values[dofs + d] * factor;
    precise float step = normal * spread;
    precise float free = from + step;
    return hold(free, frame.values[2u * dofs + d], frame.values[3u * dofs + d]);
}

// An invocation's candidate. A workgroup has eight blocks of eight candidates; rows of groups may be stacked in z.
uint candidate_here() {
    return (gl_WorkGroupID.z * gl_NumWorkGroups.x + gl_WorkGroupID.x) * (SEARCH_GROUP / 8u) + gl_LocalInvocationID.x / 8u;
}

// Its block of random numbers.
uint block_here() {
    return gl_WorkGroupID.y * 8u + gl_LocalInvocationID.x % 8u;
}
