#version 450
#extension GL_GOOGLE_include_directive : require

// What the device's rasteriser covers, kept to what the image may touch.

#include "evaluate/constants.glsl"

layout(location = 0) flat in uvec3 writes;

layout(location = 0) out vec4 colour;

layout(constant_id = 0) const uint PACKING = 0u;

void main() {
    uvec2 own = uvec2(gl_FragCoord.xy);
    uvec2 low = uvec2(writes.x & 0xffffu, writes.x >> 16);
    uvec2 high = uvec2(writes.y & 0xffffu, writes.y >> 16);
    bool inside = own.x >= low.x && own.y >= low.y && own.x < high.x && own.y < high.y;
    uint packing = PACKING;
    if (packing != PACK_MAX && !inside) discard;
    colour = unpackUnorm4x8(inside ? writes.z : 0u);
}
