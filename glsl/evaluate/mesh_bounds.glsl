// The pixels that an image of the mesh may touch, from its vertices: a workgroup's meet in shared memory, all workgroups' in the bounds.

#ifndef EVALUATE_MESH_BOUNDS
#define EVALUATE_MESH_BOUNDS

#include "evaluate/mesh.glsl"

// Low x, low y, high x, high y an image.
layout(std430, set = 0, binding = 4) buffer AllBounds { int bounds[]; };

// Low x, low y, -high x, -high y of the workgroup's part of an image.
shared int touched[4];

const int NOTHING = 0x7fffffff;

// Before the first image.
void touch_nothing() {
    if (gl_LocalInvocationID.x < 4u) touched[gl_LocalInvocationID.x] = NOTHING;
}

// Takes in the vertices of a workgroup's invocations, those that are seen, in an image whose picture has that size. All call it.
void touch(uint image, ivec2 size, bool is_seen, ivec2 at) {
    uint unit = gl_LocalInvocationID.x;
    barrier();
    if (is_seen) {
        // Triangles and outlines stay within the vertices rounded to pixels.
        ivec2 rounded = (at + 128) >> 8;
        ivec2 low = clamp(rounded, ivec2(0), size);
        ivec2 high = clamp(rounded + 1, ivec2(0), size);
        atomicMin(touched[0], low.x);
        atomicMin(touched[1], low.y);
        atomicMin(touched[2], -high.x);
        atomicMin(touched[3], -high.y);
    }
    barrier();
    if (unit < 4u) {
        int most = touched[unit];
        touched[unit] = NOTHING;
        if (most != NOTHING) {
            if (unit < 2u) {
                atomicMin(bounds[4u * image + unit], most);
            } else {
                atomicMax(bounds[4u * image + unit], -most);
            }
        }
    }
}

#endif
