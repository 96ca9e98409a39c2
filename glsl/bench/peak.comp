#version 460
// What a device can do at most, one kind of work at a time: the yardstick that passes are held to. Rounds are chosen by the host;
// what is done is counted from this code, as it is for every stage.

#include "bench/constants.glsl"

layout(local_size_x = PEAK_WORKGROUP) in;

layout(constant_id = 0) const uint KIND = 0u;

layout(std430, set = 0, binding = 0) readonly buffer Data { uvec4 data[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Result { uint result[]; };

layout(push_constant) uniform Push {
    uint rounds;
    // One less than the quadruples of `data`, a power of two.
    uint mask;
    // Invocations of all workgroups.
    uint stride;
} push;

shared uvec4 tile[PEAK_WORKGROUP];

// Independent chains of sums, shifts and bit operations.
uint integers(uint id) {
    uvec4 a = uvec4(id) + uvec4(1u, 2u, 3u, 4u);
    uvec4 b = a * 0x9E3779B1u;
    uvec4 c = b ^ uvec4(push.mask);
    uvec4 d = c + a;
    for (uint i = 0u; i < push.rounds; i++) {
        a = (a + b) ^ (c << 1);
        b = (b + c) ^ (d << 1);
        c = (c + d) ^ (a << 1);
        d = (d + a) ^ (b << 1);
        a = (a + c) ^ (d >> 1);
        b = (b + d) ^ (a >> 1);
        c = (c + a) ^ (b >> 1);
        d = (d + b) ^ (c >> 1);
    }
    a ^= b ^ c ^ d;
    return a.x ^ a.y ^ a.z ^ a.w;
}

// Independent chains of products and sums, that a device may fuse.
uint floats(uint id) {
    vec4 f = vec4(float(id & 1023u) * 1e-3, 0.25, 0.5, 0.75);
    vec4 a = f, b = f.yzwx, c = f.zwxy, d = f.wxyz;
    for (uint i = 0u; i < push.rounds; i++) {
        a = a * f + b;
        b = b * f + c;
        c = c * f + d;
        d = d * f + a;
        a = a * f - c;
        b = b * f - d;
        c = c * f - a;
        d = d * f - b;
    }
    a += b + c + d;
    return floatBitsToUint(a.x + a.y + a.z + a.w);
}

// All of a buffer larger than caches, neighbours side by side.
uint memory(uint id) {
    uvec4 sum = uvec4(0u);
    for (uint i = 0u; i < push.rounds; i++) {
        uint at = id + 8u * i * push.stride;
        for (uint k = 0u; k < 8u; k++) sum += data[(at + k * push.stride) & push.mask];
    }
    return sum.x ^ sum.y ^ sum.z ^ sum.w;
}

// Every invocation another place of the workgroup's memory.
uint shares(uint id) {
    uint lane = gl_LocalInvocationIndex;
    tile[lane] = uvec4(id) + uvec4(0u, 1u, 2u, 3u);
    barrier();
    uvec4 sum = uvec4(0u);
    for (uint i = 0u; i < push.rounds; i++) {
        for (uint k = 0u; k < 8u; k++) sum ^= tile[(lane + 8u * i + k) & (PEAK_WORKGROUP - 1u)];
    }
    return sum.x ^ sum.y ^ sum.z ^ sum.w;
}

void main() {
    uint id = gl_GlobalInvocationID.x;
    uint value = 0u;
    if (KIND == PEAK_INTEGER) value = integers(id);
    if (KIND == PEAK_FLOAT) value = floats(id);
    if (KIND == PEAK_MEMORY) value = memory(id);
    if (KIND == PEAK_SHARED) value = shares(id);
    result[id] = value;
}
