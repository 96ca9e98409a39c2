// One part of one image, as all ways of projecting compute it: trapezoid (METHOD A4), projection (A2), snapping. Whoever includes it
// says where bones are: `row_of_bone`.

#ifndef EVALUATE_PROJECT_PART
#define EVALUATE_PROJECT_PART

#include "evaluate/camera.glsl"
#include "evaluate/batch.glsl"

layout(std430, set = 0, binding = 0) readonly buffer Parts { Part parts[]; };
layout(std430, set = 0, binding = 1) readonly buffer Cameras { Camera cameras[]; };
Quad project_part(uint image, uint part_index) {
    Quad quad;
    uint candidate = image / batch.views;
    Camera camera = cameras[image % batch.views];
    Part part = parts[part_index];
    vec4 row0 = row_of_bone(candidate, part.bone, 0u);
    vec4 row1 = row_of_bone(candidate, part.bone, 1u);
    vec4 row2 = row_of_bone(candidate, part.bone, 2u);
    vec3 a = transform(row0, row1, row2, part.a);
    vec3 b = transform(row0, row1, row2, part.b);

    vec3 corners[4];
    precise vec3 u = a - b;
    precise vec3 n = camera.centre - b;
    vec3 c = cross3(u, n);
    float cc = dot3(c, c);
    precise float least = 1e-6 * (dot3(u, u) * dot3(n, n));
    if (cc >= least && cc > 0.0) {
        float inverse = quotient(1.0, square_root(cc));
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
        float inverse = quotient(1.0, square_root(dot3(view, view)));
        view = scale3(view, inverse);
        uint axis = 0u;
        if (abs(view.y) < abs(view[axis])) axis = 1u;
        if (abs(view.z) < abs(view[axis])) axis = 2u;
        vec3 unit = vec3(axis == 0u, axis == 1u, axis == 2u);
        precise vec3 side = unit - scale3(view, view[axis]);
        float to_radius = quotient(radius, square_root(dot3(side, side)));
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
    return quad;
}

#endif
