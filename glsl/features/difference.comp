#version 450
#extension GL_GOOGLE_include_directive : require

// What differs from the plate (METHOD A5.1): src/features/plate.rs, operation by operation.

#include "features/constants.glsl"
#include "features/shadow.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Colours { uint colours[]; };
layout(std430, set = 0, binding = 1) readonly buffer Plate { uint plate[]; };
layout(std430, set = 0, binding = 2) readonly buffer Gains { uint gains[]; };
layout(std430, set = 0, binding = 3) writeonly buffer Weak { uint weak[]; };
layout(std430, set = 0, binding = 4) writeonly buffer Strong { uint strong[]; };
layout(std430, set = 0, binding = 5) writeonly buffer Faint { uint faint[]; };

layout(push_constant) uniform Difference {
    uint width;
    uint stride;
    float weak_squared;
    float strong_squared;
    float faint_squared;
    uint suppress; // whether shadows are left out
    float darkest;
    float brightest;
    float chroma_squared;
} push;

shared uint words[6];

uint colour_byte(uint at) {
    return (colours[at >> 2u] >> (8u * (at & 3u))) & 255u;
}

uint plate_byte(uint at) {
    return (plate[at >> 2u] >> (8u * (at & 3u))) & 255u;
}

void main() {
    uint lane = gl_LocalInvocationID.x;
    uint x = gl_GlobalInvocationID.x;
    uint y = gl_GlobalInvocationID.y;
    if (lane < 6u) words[lane] = 0u;
    barrier();
    if (x < push.width) {
        uint at = 3u * (y * push.width + x);
        vec3 seen = vec3(float(colour_byte(at)), float(colour_byte(at + 1u)), float(colour_byte(at + 2u)));
        vec3 gain = vec3(float(gains[0]), float(gains[1]), float(gains[2])) * 0.0078125;
        precise vec3 lit = vec3(float(plate_byte(at)), float(plate_byte(at + 1u)), float(plate_byte(at + 2u))) * gain;
        // What would be brighter than white is white.
        vec3 background = min(lit, vec3(255.0));
        precise vec3 apart = seen - background;
        float distance_squared = product(apart, apart);
        bool differs = push.suppress == 0u || !covers(seen, background, push.darkest, push.brightest, push.chroma_squared);
        precise float plate_sum = background.x + background.y + background.z;
        bool both_dark = max(plate_sum, seen.x + seen.y + seen.z) < float(DARK);
        uint half_ = lane >> 5u;
        uint bit = 1u << (lane & 31u);
        if (differs && distance_squared >= push.weak_squared) atomicOr(words[half_], bit);
        if (differs && distance_squared >= push.strong_squared) atomicOr(words[2u + half_], bit);
        if (both_dark || (differs && distance_squared >= push.faint_squared)) atomicOr(words[4u + half_], bit);
    }
    barrier();
    if ((lane & 31u) == 0u) {
        uint place = y * push.stride + (x >> 5u);
        weak[place] = words[lane >> 5u];
        strong[place] = words[2u + (lane >> 5u)];
        faint[place] = words[4u + (lane >> 5u)];
    }
}
