// What people wear: the tailor's own patterns of synth/actor.rs, or a scene's finishes.

#ifndef SYNTH_CLOTHES
#define SYNTH_CLOTHES

#include "synth/scene.glsl"

layout(std430, set = 0, binding = 6) readonly buffer Finishes { Finish finishes[]; };

#define MATERIAL(of) finishes[of].material
#include "texture/materials_at.glsl"

// A number in [0, 1) for a cell of an integer lattice.
float cell_number(ivec2 cell, uint layer) {
    uvec2 x = product64(extended64(cell.x), uvec2(0x7F4A7C15u, 0x9E3779B9u));
    uvec2 y = product64(extended64(cell.y), uvec2(0x27D4EB4Fu, 0xC2B2AE3Du));
    uvec2 z = product64(uvec2(layer, 0u), uvec2(0x9E3779F9u, 0x165667B1u));
    return float(mixed64(sum64(x ^ y, z))) / 4294967296.0;
}

// Smooth noise in [0, 1] over the plane.
float smooth_noise(vec2 at, uint layer) {
    vec2 base = floor(at);
    ivec2 cell = ivec2(base);
    vec2 t = at - base;
    t = t * t * (3.0 - 2.0 * t);
    float low = mix(cell_number(cell, layer), cell_number(cell + ivec2(1, 0), layer), t.x);
    float high = mix(cell_number(cell + ivec2(0, 1), layer), cell_number(cell + ivec2(1, 1), layer), t.x);
    return mix(low, high, t.y);
}

float grain(vec3 at, float scale) {
    return 0.9 + 0.2 * smooth_noise(vec2(at.y / scale + 3.1 * at.x / scale, at.z / scale), 31u);
}

// The tailor's own colour at a point of the object, mm.
vec3 own_colour(uint look, vec3 at) {
    switch (look) {
        case LOOK_HAIR: return vec3(0.055, 0.032, 0.02) * (0.7 + 0.6 * smooth_noise(vec2(at.y / 7.0, at.x / 40.0), 33u));
        case LOOK_SHIRT: {
            bool band = fract(at.z / 105.0) < 0.2;
            return (band ? vec3(0.66, 0.58, 0.46) : vec3(0.56, 0.085, 0.05)) * grain(at, 26.0);
        }
        case LOOK_TROUSERS: return vec3(0.045, 0.075, 0.17) * grain(at, 18.0);
        case LOOK_SHOE: return vec3(0.10, 0.05, 0.03);
        case LOOK_FACE: return vec3(0.58, 0.33, 0.225);
    }
    return vec3(0.55, 0.31, 0.21);
}

// What is painted on a face at a point of its ball's own frame; negative where nothing is.
vec3 painted_face(bool is_jaw, vec3 at) {
    vec3 nothing = vec3(-1.0);
    if (at.x < 0.5 || is_jaw) {
        return at.x > 0.6 && abs(at.y) < 0.42 && abs(at.z + 0.08) < 0.1 ? vec3(0.36, 0.13, 0.11) : nothing;
    }
    float side = abs(at.y) - 0.42;
    vec2 eye = vec2(side / 0.15, (at.z + 0.06) / 0.075);
    if (dot(eye, eye) < 1.0) return vec3(0.06, 0.05, 0.05);
    return abs(side) < 0.22 && abs(at.z - 0.14) < 0.04 ? vec3(0.10, 0.06, 0.04) : nothing;
}

// The colour of a garment, its finish one more than a number or 0.
vec3 worn_colour(uint look, uint finish, vec3 at) {
    if (finish == 0u) return own_colour(look, at);
    uint of = finish - 1u;
    uint kind = finishes[of].material.kind;
    vec4 tint = finishes[of].tint;
    if (kind == 0u) return tint.rgb;
    // Materials lie in their x and y: around and up the body.
    vec3 colour = texel_at(kind, of, at.yzx / tint.w).colour;
    return tint.rgb * min(linear_light(colour), vec3(0.9));
}

// Creases of cloth: a small tilt of the normal.
vec3 folds(uint look, vec3 at) {
    float depth = look == LOOK_SHIRT ? 0.34 : (look == LOOK_TROUSERS ? 0.38 : (look == LOOK_HAIR ? 0.30 : 0.0));
    float width = look == LOOK_SHIRT ? 62.0 : (look == LOOK_TROUSERS ? 70.0 : 14.0);
    if (depth == 0.0) return vec3(0.0);
    float around = atan(at.y, at.x) * 90.0;
    vec2 place = vec2(around / width + at.z / (2.2 * width), at.z / width);
    return (vec3(smooth_noise(place, 41u), smooth_noise(place, 42u), smooth_noise(place, 43u)) - 0.5) * depth;
}

#endif
