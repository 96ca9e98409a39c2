#version 450
#extension GL_GOOGLE_include_directive : require

// Every part of every candidate in every camera, once: trapezoid (SPEC A4), projection (A2), snapping, depth order, and the
// pixels that the image may touch. A workgroup takes as many whole images as it has room for; the quads of an image are
// written nearest first.

#include "evaluate/constants.glsl"
#include "evaluate/camera.glsl"
#include "evaluate/batch.glsl"

layout(local_size_x = PROJECT_GROUP) in;

layout(std430, set = 0, binding = 0) readonly buffer Parts { Part parts[]; };
layout(std430, set = 0, binding = 1) readonly buffer Cameras { Camera cameras[]; };
layout(std430, set = 0, binding = 2) readonly buffer World { vec4 world[]; };
layout(std430, set = 0, binding = 3) writeonly buffer Quads { Quad quads[]; };
layout(std430, set = 0, binding = 4) writeonly buffer AllBounds { Bounds bounds[]; };

shared uint depth_bits[PROJECT_GROUP];
shared int low_x[PROJECT_GROUP];
shared int low_y[PROJECT_GROUP];
shared int high_x[PROJECT_GROUP];
shared int high_y[PROJECT_GROUP];

void main() {
    uint images_a_group = PROJECT_GROUP / batch.parts;
    uint slot = gl_LocalInvocationID.x / batch.parts;
    uint part_index = gl_LocalInvocationID.x % batch.parts;
    uint image = gl_WorkGroupID.x * images_a_group + slot;
    bool active_here = slot < images_a_group && image < batch.candidates * batch.views;

    Quad quad;
    Camera camera;
    if (active_here) {
        uint candidate = image / batch.views;
        camera = cameras[image % batch.views];
        Part part = parts[part_index];
        uint rows = 3u * (candidate * batch.bones + part.bone);
        vec4 row0 = world[rows], row1 = world[rows + 1u], row2 = world[rows + 2u];
        vec3 a = transform(row0, row1, row2, part.a);
        vec3 b = transform(row0, row1, row2, part.b);

        vec3 corners[4];
        precise vec3 u = a - b;
        precise vec3 n = camera.centre - b;
        vec3 c = cross3(u, n);
        float cc = dot3(c, c);
        precise float least = 1e-6 * (dot3(u, u) * dot3(n, n));
        if (cc >= least && cc > 0.0) {
            precise float inverse = 1.0 / sqrt(cc);
            vec3 r = scale3(c, inverse);
            precise vec3 ra = scale3(r, part.radius_a);
            precise vec3 rb = scale3(r, part.radius_b);
            corners[0] = a + ra;
            corners[1] = b + rb;
            corners[2] = b - rb;
            corners[3] = a - ra;
        } else {
            // Along the limb: the square around the larger disc, sides along the world axis least parallel to the view.
            bool a_is_larger = part.radius_a >= part.radius_b;
            vec3 disc = a_is_larger ? a : b;
            float radius = a_is_larger ? part.radius_a : part.radius_b;
            precise vec3 view = camera.centre - disc;
            precise float inverse = 1.0 / sqrt(dot3(view, view));
            view = scale3(view, inverse);
            uint axis = 0u;
            if (abs(view.y) < abs(view[axis])) axis = 1u;
            if (abs(view.z) < abs(view[axis])) axis = 2u;
            vec3 unit = vec3(axis == 0u, axis == 1u, axis == 2u);
            precise vec3 side = unit - scale3(view, view[axis]);
            precise float to_radius = radius / sqrt(dot3(side, side));
            side = scale3(side, to_radius);
            vec3 up = cross3(view, side);
            precise vec3 plus = disc + side;
            precise vec3 minus = disc - side;
            corners[0] = plus + up;
            corners[1] = minus + up;
            corners[2] = minus - up;
            corners[3] = plus - up;
        }

        bool drawn = true;
        quad.x = ivec4(0);
        quad.y = ivec4(0);
        for (int corner = 0; corner < 4; corner++) {
            bool has_image;
            vec3 pixel = project_point(camera, corners[corner], has_image);
            drawn = drawn && has_image;
            quad.x[corner] = has_image ? snap(pixel.x) : 0;
            quad.y[corner] = has_image ? snap(pixel.y) : 0;
        }
        if (!drawn) {
            quad.x = ivec4(0);
            quad.y = ivec4(0);
        }
        quad.drawn = drawn ? 1u : 0u;
        quad.label = part.label;
        quad.part = part_index;
        precise vec3 sum = a + b;
        precise vec3 d = scale3(sum, 0.5) - camera.centre;
        quad.depth_squared = dot3(d, d);
        depth_bits[gl_LocalInvocationID.x] = floatBitsToUint(quad.depth_squared);

        // Fill and border stay within the corners rounded to pixels.
        ivec4 px = (quad.x + 128) >> 8;
        ivec4 py = (quad.y + 128) >> 8;
        ivec2 size = ivec2(camera.size);
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
        all.low = ivec2(camera.size);
        all.high = ivec2(0);
        for (uint other = 0u; other < batch.parts; other++) {
            all.low = min(all.low, ivec2(low_x[first + other], low_y[first + other]));
            all.high = max(all.high, ivec2(high_x[first + other], high_y[first + other]));
        }
        bounds[image] = all;
    }
}
