// The parts of an image from the nearest on, and the pixels that the image may touch. A workgroup takes as many whole images as
// it has room for, an invocation a part.

#ifndef EVALUATE_ORDER
#define EVALUATE_ORDER

#include "evaluate/constants.glsl"
#include "evaluate/model.glsl"
#include "evaluate/batch.glsl"

layout(std430, set = 0, binding = 3) writeonly buffer Quads { Quad quads[]; };
layout(std430, set = 0, binding = 4) writeonly buffer AllBounds { Bounds bounds[]; };

shared uint depth_bits[PROJECT_GROUP];
shared int low_x[PROJECT_GROUP];
shared int low_y[PROJECT_GROUP];
shared int high_x[PROJECT_GROUP];
shared int high_y[PROJECT_GROUP];

// What an invocation works on.
struct Own {
    uint slot;  // of the image in the workgroup
    uint part;  // in the body
    uint image; // in the batch
    bool is_active;
};

// In a workgroup of `group` invocations: its size is not known before the stage has said it.
Own own_part(uint group) {
    Own own;
    uint images_a_group = group / batch.parts;
    own.slot = gl_LocalInvocationID.x / batch.parts;
    own.part = gl_LocalInvocationID.x % batch.parts;
    own.image = gl_WorkGroupID.x * images_a_group + own.slot;
    own.is_active = own.slot < images_a_group && own.image < batch.candidates * batch.views;
    return own;
}

// Writes the workgroup's images. All invocations call it; `quad` is the own part of the active ones, in a picture of `size`.
void write_in_order(Own own_place, Quad quad, uvec2 size_of_picture) {
    bool active_here = own_place.is_active;
    uint slot = own_place.slot;
    uint part_index = own_place.part;
    uint image = own_place.image;
    ivec2 size = ivec2(size_of_picture);
    if (active_here) {
        depth_bits[gl_LocalInvocationID.x] = floatBitsToUint(quad.depth_squared);
        bool drawn = quad.drawn == 1u;

        // Fill and border stay within the corners rounded to pixels.
        ivec4 px = (quad.x + 128) >> 8;
        ivec4 py = (quad.y + 128) >> 8;
        int left = clamp(min(min(px.x, px.y), min(px.z, px.w)), 0, size.x);
        int right = clamp(max(max(px.x, px.y), max(px.z, px.w)) + 1, 0, size.x);
        int top = clamp(min(min(py.x, py.y), min(py.z, py.w)), 0, size.y);
        int bottom = clamp(max(max(py.x, py.y), max(py.z, py.w)) + 1, 0, size.y);
        bool inside = drawn && left < right && top < bottom;
        low_x[gl_LocalInvocationID.x] = inside ? left : size.x;
        low_y[gl_LocalInvocationID.x] = inside ? top : size.y;
        high_x[gl_LocalInvocationID.x] = inside ? right : 0;
        high_y[gl_LocalInvocationID.x] = inside ? bottom : 0;
    }
    barrier();
    if (!active_here) return;

    // Its place from the nearest part on; at equal depth the part listed later is the nearer one.
    uint first = slot * batch.parts;
    uint own = depth_bits[gl_LocalInvocationID.x];
    uint place = 0u;
    for (uint other = 0u; other < batch.parts; other++) {
        uint bits = depth_bits[first + other];
        if (bits < own || (bits == own && other > part_index)) place++;
    }
    quads[image * batch.parts + place] = quad;

    if (part_index == 0u) {
        Bounds all;
        all.low = size;
        all.high = ivec2(0);
        for (uint other = 0u; other < batch.parts; other++) {
            all.low = min(all.low, ivec2(low_x[first + other], low_y[first + other]));
            all.high = max(all.high, ivec2(high_x[first + other], high_y[first + other]));
        }
        bounds[image] = all;
    }
}

#endif
