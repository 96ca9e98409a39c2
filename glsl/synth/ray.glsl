// Where a ray first meets a person's primitives; the formulas of synth/solid.rs and synth/triangle.rs.

#ifndef SYNTH_RAY
#define SYNTH_RAY

#include "synth/scene.glsl"

// Distances are from a ray's start, negative where it meets nothing.
const float MISS = -1.0;

// v, of length 1 unless it has none.
vec3 unit(vec3 v) {
    float size = dot(v, v);
    return size > 0.0 ? v * inversesqrt(size) : vec3(0.0);
}

// The smaller root of a t^2 + 2 b t + c.
float smaller_root(float a, float b, float c) {
    float discriminant = b * b - a * c;
    if (!(a > 0.0) || !(discriminant >= 0.0)) return MISS;
    float t = (-b - sqrt(discriminant)) / a;
    return t > 0.0 ? t : MISS;
}

float ball_hit(vec3 o, vec3 d, vec3 centre, float radius) {
    vec3 from = o - centre;
    float a = dot(d, d);
    // About the point that is nearest to the centre, so that a far start costs no digits.
    float nearest = -dot(from, d) / a;
    vec3 beside = from + d * nearest;
    float inside = (radius * radius - dot(beside, beside)) / a;
    if (!(inside >= 0.0)) return MISS;
    float t = nearest - sqrt(inside);
    return t > 0.0 ? t : MISS;
}

float nearer(float a, float b) {
    return a < 0.0 || (b >= 0.0 && b < a) ? b : a;
}

float capsule_hit(vec3 o, vec3 d, float height, float radius_a, float radius_b) {
    float sine = (radius_a - radius_b) / height;
    float ends = nearer(ball_hit(o, d, vec3(0.0), radius_a), ball_hit(o, d, vec3(0.0, 0.0, height), radius_b));
    if (abs(sine) >= 1.0) return ends;
    float cosine = sqrt(1.0 - sine * sine);
    float w0 = (radius_a - sine * o.z) / cosine;
    float w1 = -sine * d.z / cosine;
    float a = dot(d.xy, d.xy) - w1 * w1;
    float b = dot(o.xy, d.xy) - w0 * w1;
    float c = dot(o.xy, o.xy) - w0 * w0;
    float t = smaller_root(a, b, c);
    if (t < 0.0) return ends;
    float z = o.z + d.z * t;
    return z < radius_a * sine || z > height + radius_b * sine ? ends : nearer(ends, t);
}

// A vector in the frame of solid `i`.
vec3 solid_local(uint i, vec3 v) {
    return vec3(dot(solids[i].local[0].xyz, v), dot(solids[i].local[1].xyz, v), dot(solids[i].local[2].xyz, v));
}

float solid_hit(uint i, vec3 origin, vec3 direction) {
    vec4 centre = solids[i].centre;
    vec3 to_centre = centre.xyz - origin;
    float along = dot(to_centre, direction);
    // Most rays of a tile pass by: a ball round all of it tells sooner.
    vec3 beside = direction * along - to_centre;
    if (dot(beside, beside) > centre.w * centre.w) return MISS;
    float approach = max(along - 2.0 * centre.w, 0.0);
    vec3 o = solid_local(i, direction * approach - to_centre);
    vec3 d = solid_local(i, direction);
    float t = MISS;
    if (solids[i].is_capsule != 0u) {
        t = capsule_hit(o, d, solids[i].local[0].w, solids[i].local[1].w, solids[i].local[2].w);
    } else {
        t = ball_hit(o, d, vec3(0.0), 1.0);
    }
    return t < 0.0 ? MISS : approach + t;
}

// How far a point near solid `i` is outside of it, mm, and the normal there.
float solid_near(uint i, vec3 point, out vec3 normal) {
    vec3 p = solid_local(i, point - solids[i].centre.xyz);
    float height = 0.0;
    float radius = 1.0;
    if (solids[i].is_capsule != 0u) {
        float span = solids[i].local[0].w;
        float sine = clamp((solids[i].local[1].w - solids[i].local[2].w) / span, -0.999, 0.999);
        height = clamp(p.z - length(p.xy) * sine / sqrt(1.0 - sine * sine), 0.0, span);
        radius = solids[i].local[1].w - sine * height;
    }
    vec3 from = p - vec3(0.0, 0.0, height);
    float range = length(from);
    vec3 v = range > 0.0 ? from / range : vec3(0.0, 0.0, 1.0);
    vec3 gradient = solids[i].local[0].xyz * v.x + solids[i].local[1].xyz * v.y + solids[i].local[2].xyz * v.z;
    float steepness = max(length(gradient), 1e-12);
    normal = gradient / steepness;
    return (range - radius) / steepness;
}

float triangle_hit(uint i, vec3 origin, vec3 direction) {
    vec3 e = triangles[i].edges[0].xyz;
    vec3 f = triangles[i].edges[1].xyz;
    vec3 p = cross(direction, f);
    float volume = dot(e, p);
    if (abs(volume) < 1e-12) return MISS;
    vec3 from = origin - triangles[i].corner.xyz;
    float u = dot(from, p) / volume;
    vec3 q = cross(from, e);
    float v = dot(direction, q) / volume;
    float t = dot(f, q) / volume;
    return u < 0.0 || v < 0.0 || u + v > 1.0 || !(t > 0.0) ? MISS : t;
}

float first_hit(bool is_mesh, uint primitive, vec3 origin, vec3 direction) {
    if (is_mesh) return triangle_hit(primitive, origin, direction);
    return solid_hit(primitive, origin, direction);
}

// Whether a member stands between a point and the light.
bool in_shadow(uint number, vec3 point) {
    Member member = members[number];
    vec2 flat_point = vec2(dot(point, member.across[0].xyz), dot(point, member.across[1].xyz));
    vec2 at = (flat_point - member.bins_origin) / member.bin_width;
    if (any(lessThan(at, vec2(0.0))) || any(greaterThanEqual(at, vec2(member.bins_size)))) return false;
    uint bin = member.first_bin + uint(at.y) * member.bins_size.x + uint(at.x);
    for (uint i = bins[bin]; i < bins[bin + 1u]; i++) {
        if (first_hit(member.is_mesh != 0u, bins[i], point, member.to_light.xyz) > 0.0) return true;
    }
    return false;
}

#endif
