#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Pixels of a picture of a material: its colours or heights on a plane, or its colours where rays meet a lit object.

#include "texture/constants.glsl"
#include "texture/materials.glsl"

layout(local_size_x = 64) in;

struct PictureRequest {
    uvec2 size;      // of the picture, pixels
    uint first;      // pixel of this run, row by row
    uint pixels;     // of this run
    vec3 offset;     // object units at the picture's lower left corner
    float pixel;     // side of a pixel, object units
    uint samples;    // of a pixel, along each axis
};

layout(std430, set = 0, binding = 0) readonly buffer Materials { Material material; };
layout(std430, set = 0, binding = 1) readonly buffer Tables { float tables[]; };
layout(set = 0, binding = 2) uniform utexture2D noise_tables;
layout(set = 0, binding = 3) uniform texture3D noise_volume;
layout(std430, set = 0, binding = 4) readonly buffer AllRequests { PictureRequest request; };
// Where each sample's ray meets the object, and the cosine of the light there; -2 where it does not.
layout(std430, set = 0, binding = 5) readonly buffer Rays { vec4 rays[]; };
// Red and green, then blue, 16 bits each; or the height.
layout(std430, set = 0, binding = 6) writeonly buffer Words { uvec2 words[]; };

// MATERIAL_*
layout(constant_id = 0) const uint KIND = 1u;
// 0 by arithmetic, 1 from tables, 2 from a volume.
layout(constant_id = 1) const uint WAY = 0u;
// SHOWS_*
layout(constant_id = 2) const uint SHOWS = 0u;

#define MATERIAL(of) material
#define MATERIAL_TABLES(i) tables[i]
#define NOISE_WAY WAY
#define NOISE_TABLE(i) texelFetch(noise_tables, ivec2(int((i) & 255u), int((i) >> 8)), 0).x
#include "texture/noise.glsl"

float volume_sample(ivec3 at) {
    return texelFetch(noise_volume, at, 0).x;
}

// Between the samples of a cube, of which there are eight a cell; `shift` moves it, seven bits an axis.
float noise_of_volume(uint shift, vec3 q) {
    const int LAST = 127;
    precise vec3 at = q * 8.0;
    vec3 t;
    float rest;
    ivec3 cell;
    for (int axis = 0; axis < 3; axis++) {
        cell[axis] = noise_split(at[axis], rest);
        t[axis] = rest;
    }
    uvec3 moved = uvec3(cell) + uvec3(shift, shift >> 7, shift >> 14);
    ivec3 near = ivec3(moved) & LAST;
    ivec3 far = ivec3(moved + 1u) & LAST;
    float faces[2];
    for (int face = 0; face < 2; face++) {
        int z = face == 0 ? near.z : far.z;
        float low = noise_mix(volume_sample(ivec3(near.x, near.y, z)), volume_sample(ivec3(far.x, near.y, z)), t.x);
        float high = noise_mix(volume_sample(ivec3(near.x, far.y, z)), volume_sample(ivec3(far.x, far.y, z)), t.x);
        faces[face] = noise_mix(low, high, t.y);
    }
    return noise_mix(faces[0], faces[1], t.z);
}

float noise_in_a_way(uint state, ivec4 period, vec3 q) {
    uint way = WAY;
    if (way == 2u) return noise_of_volume(state, q);
    uint word;
    return noise(Lattice(way == 1u, state, period), false, 3u, vec4(q, 0.0), word);
}

#include "texture/materials_at.glsl"

const float BACKGROUND = 0.05;

// Light as a screen shows it, sRGB.
float encoded(float x) {
    precise float small = 12.92 * x;
    precise float curve = 1.055 * real_power(min(x, 1.0), 0.41666666) - 0.055;
    return x <= 0.0031308 ? small : curve;
}

uint word16(float x) {
    precise float scaled = clamp(x, 0.0, 1.0) * 65535.0 + 0.5;
    return uint(scaled);
}

// The point at (u, v) of a pixel, each from 0 to 1.
vec3 point_of(uint x, uint y, vec2 place) {
    uint up = request.size.y - 1u - y;
    precise vec2 at = request.offset.xy + (vec2(float(x), float(up)) + place) * request.pixel;
    return vec3(at, request.offset.z);
}

// What a sample adds to its pixel: linear light, or a height.
vec3 sample_of(uint kind, uint shows, uint pixel, uint number, uint samples, uint x, uint y) {
    vec3 p;
    float shade = 1.0;
    if (shows == SHOWS_RAYS) {
        vec4 ray = rays[pixel * samples * samples + number];
        if (ray.w < -1.5) return vec3(BACKGROUND);
        precise float light = 0.12 + 0.95 * max(ray.w, 0.0);
        shade = light;
        p = ray.xyz;
    } else {
        precise vec2 middle = vec2(float(number % samples), float(number / samples)) + 0.5;
        p = point_of(x, y, vec2(quotient(middle.x, float(samples)), quotient(middle.y, float(samples))));
    }
    Texel texel = texel_at(kind, 0u, p);
    if (shows == SHOWS_HEIGHTS) return vec3(texel.height);
    return shows == SHOWS_RAYS ? dimmed(linear_light(texel.colour), shade) : linear_light(texel.colour);
}

void main() {
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= request.pixels) return;
    uint kind = KIND;
    uint shows = SHOWS;
    uint number = request.first + pixel;
    uint x = number % request.size.x;
    uint y = number / request.size.x;
    uint samples = request.samples;
    vec3 shown;
    if (shows == SHOWS_COLOURS && samples == 1u) {
        shown = texel_at(kind, 0u, point_of(x, y, vec2(0.5))).colour;
    } else {
        precise vec3 sum = vec3(0.0);
        for (uint i = 0u; i < samples * samples; i++) sum = sum + sample_of(kind, shows, pixel, i, samples, x, y);
        float count = float(samples * samples);
        vec3 mean = vec3(quotient(sum.x, count), quotient(sum.y, count), quotient(sum.z, count));
        shown = shows == SHOWS_HEIGHTS ? mean : vec3(encoded(mean.x), encoded(mean.y), encoded(mean.z));
    }
    words[pixel] = uvec2(word16(shown.r) | word16(shown.g) << 16, word16(shown.b));
}
