#version 450
#extension GL_GOOGLE_include_directive : require

// Random mid-point displacement over a torus, half a level a pass: the middles of squares, then those of sides, each from the four points
// around it, which are there by then. When all levels are done, the least and greatest height are found and the heights scaled to [0, 1].

#include "arithmetic/rounding.glsl"
#include "texture/constants.glsl"
#include "texture/mixed64.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) buffer Surface { float surface[]; };
// The greatest of the heights' keys and of these inverted, which is the least: both grow from 0.
layout(std430, set = 0, binding = 1) buffer Extremes { uint extremes[]; };

layout(push_constant) uniform Displace {
    uint first;      // height in the buffer
    uint side;       // points of the torus, a power of two
    uint halved;     // points from a middle to the points it comes from
    uint seed;       // already mixed
    float amplitude; // of this half of a level
} push;

// DISPLACES_*
layout(constant_id = 0) const uint DISPLACES = 0u;

shared uint here[2];

float height(uint x, uint y) {
    uint last = push.side - 1u;
    return surface[push.first + (y & last) * push.side + (x & last)];
}

// A word that is the greater the greater the number is, and back.
uint key_of(float x) {
    uint bits = floatBitsToUint(x);
    return bits ^ ((bits >> 31) != 0u ? 0xffffffffu : 0x80000000u);
}

float of_key(uint key) {
    return uintBitsToFloat(key ^ ((key >> 31) != 0u ? 0x80000000u : 0xffffffffu));
}

void displace(uint x, uint y, float a, float b, float c, float d) {
    uint at = y * push.side + x;
    uint word = mixed64(uvec2(at, push.seed));
    precise float die = float(word >> 8) * (1.0 / 8388608.0) - 1.0;
    precise float sum = ((a + b) + c) + d;
    precise float moved = sum * 0.25 + push.amplitude * die;
    surface[push.first + at] = moved;
}

void main() {
    uvec2 at = gl_GlobalInvocationID.xy;
    uint span = push.halved;
    uint squares = push.side / (2u * span);
    uint lane = gl_LocalInvocationID.x;
    uint place = push.first + at.y * push.side + at.x;
    bool is_inside = at.x < push.side && at.y < push.side;
    switch (DISPLACES) {
    case DISPLACES_SQUARES:
        if (at.x < squares && at.y < squares) {
            uvec2 p = (2u * at + 1u) * span;
            displace(p.x, p.y, height(p.x - span, p.y - span), height(p.x + span, p.y - span), height(p.x - span, p.y + span),
                     height(p.x + span, p.y + span));
        }
        break;
    case DISPLACES_SIDES:
        if (at.x < squares && at.y < 2u * squares) {
            uvec2 p = uvec2(2u * at.x + 1u - (at.y & 1u), at.y) * span;
            displace(p.x, p.y, height(p.x - span, p.y), height(p.x + span, p.y), height(p.x, p.y - span), height(p.x, p.y + span));
        }
        break;
    case DISPLACES_EXTREMES:
        if (lane < 2u) here[lane] = 0u;
        barrier();
        if (is_inside) {
            uint key = key_of(surface[place]);
            atomicMax(here[0], key);
            atomicMax(here[1], ~key);
        }
        barrier();
        if (lane < 2u) atomicMax(extremes[lane], here[lane]);
        break;
    default:
        if (is_inside) {
            float least = of_key(~extremes[1]);
            precise float range = of_key(extremes[0]) - least;
            precise float above = surface[place] - least;
            surface[place] = quotient(above, max(range, uintBitsToFloat(0x00800000u)));
        }
        break;
    }
}
