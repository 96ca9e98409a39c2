// A point of the world to pixels (METHOD A2), rounded as the reference rounds.

#ifndef EVALUATE_CAMERA
#define EVALUATE_CAMERA

#include "evaluate/model.glsl"
#include "evaluate/arithmetic.glsl"
#include "arithmetic/rounding.glsl"

// Pixels in x and y, and the depth along the axis in z; `has_image` says whether the point is in front of the camera, inside of
// the distortion's branch and near enough.
vec3 project_point(Camera camera, vec3 point, out bool has_image) {
    vec3 p = transform(camera.camera_from_world[0], camera.camera_from_world[1], camera.camera_from_world[2], point);
    float inverse = quotient(1.0, p.z);
    precise float x = p.x * inverse;
    precise float y = p.y * inverse;
    precise float r2 = x * x + y * y;
    precise vec2 pixel;
    bool on_branch;
    if (camera.lens == LENS_TSAI) {
        // With s = r_d / r_u the cubic reads s + q s^3 = 1, q = kappa r_u^2. Its branch ends at q = -4/27. Halley's steps.
        precise float q = camera.radial.x * r2;
        precise float s = 1.0;
        for (int step = 0; step < 6; step++) {
            precise float value = s + q * s * s * s - 1.0;
            precise float slope = 1.0 + 3.0 * q * s * s;
            precise float bend = 3.0 * q * s;
            precise float rise = value * slope;
            precise float run = slope * slope - value * bend;
            s = s - quotient(rise, run);
        }
        pixel.x = camera.focal.x * (x * s) + camera.principal.x;
        pixel.y = camera.focal.y * (y * s) + camera.principal.y;
        on_branch = q >= -4.0 / 27.0;
    } else {
        vec3 k = camera.radial;
        vec2 t = camera.tangential;
        precise float radial = 1.0 + r2 * (k.x + r2 * (k.y + r2 * k.z));
        precise float xy2 = 2.0 * (x * y);
        precise float distorted_x = x * radial + (t.x * xy2 + t.y * (r2 + 2.0 * (x * x)));
        precise float distorted_y = y * radial + (t.x * (r2 + 2.0 * (y * y)) + t.y * xy2);
        pixel.x = camera.focal.x * distorted_x + camera.principal.x;
        pixel.y = camera.focal.y * distorted_y + camera.principal.y;
        on_branch = r2 <= camera.max_radius_squared;
    }
    // Written so that a NaN fails every test.
    has_image = p.z > 0.0 && on_branch && abs(pixel.x) <= FARTHEST_PIXEL && abs(pixel.y) <= FARTHEST_PIXEL;
    return vec3(pixel, p.z);
}

#endif
