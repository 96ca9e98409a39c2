// How likely the colour of a pixel is as background (METHOD A12): src/features/likelihood/background.rs, operation by operation. What
// that takes logarithms of is looked up.

#ifndef FEATURES_LIKELY
#define FEATURES_LIKELY

#include "features/constants.glsl"
#include "arithmetic/rounding.glsl"

// The constants of a slope of the background.
struct Widths {
    float y; // 1 / variance of luma
    float c; // and of the other two
    float lit;
    float shadow;
};

layout(std430, set = 0, binding = 0) readonly buffer Colours { uint colours[]; };
layout(std430, set = 0, binding = 1) readonly buffer Plate { uint plate[]; };
// Of the plate's luma, at least 4.
layout(std430, set = 0, binding = 2) readonly buffer Logarithms { float logarithms[]; };
// A byte a pixel.
layout(std430, set = 0, binding = 3) readonly buffer Slopes { uint slopes[]; };
layout(std430, set = 0, binding = 4) readonly buffer LightTable {
    float dim[3];     // what to multiply the picture with
    float outlier;    // log density of an outlier
    float range[2];   // darkest shadow, brightest reflection
    float logs[2];    // log densities on both sides of the background's own brightness
    float falls[2];   // and how fast they fall
    float assumed[2]; // pixels in shadow and all that are assumed before any is counted
    float believed[2];
    float from[SHADOW_STEPS - 1u]; // the smallest share of shadows of each step but the first
    Widths counting[LIKELY_SLOPES];
    Widths judging[SHADOW_STEPS * LIKELY_SLOPES];
} light;
// As bounds.comp leaves them.
layout(std430, set = 0, binding = 5) readonly buffer Sides { uint sides[]; };

layout(push_constant) uniform Likely {
    uint width;
    uint height;
    uint motion; // room round what was found, pixels
    uint again;  // whether only that is judged
} push;

uint colour_byte(uint at) {
    return (colours[at >> 2u] >> (8u * (at & 3u))) & 255u;
}

uint plate_byte(uint at) {
    return (plate[at >> 2u] >> (8u * (at & 3u))) & 255u;
}

// Luma, blue less luma, red less luma.
vec3 luminance(vec3 colour) {
    precise float y = 0.299 * colour.x + 0.587 * colour.y + 0.114 * colour.z;
    precise vec3 found = vec3(y, colour.z - y, colour.x - y);
    return found;
}

uvec3 colour_of(uint pixel) {
    return uvec3(colour_byte(3u * pixel), colour_byte(3u * pixel + 1u), colour_byte(3u * pixel + 2u));
}

uint slope_of(uint pixel) {
    return (slopes[pixel >> 2u] >> (8u * (pixel & 3u))) & 255u;
}

// The log density of a colour as lit background and as background in another light, over the uniform one.
vec2 hypotheses(uvec3 colour, uint pixel, Widths widths) {
    precise vec3 dimmed = vec3(colour) * vec3(light.dim[0], light.dim[1], light.dim[2]);
    vec3 seen = luminance(dimmed);
    vec3 behind = vec3(plate_byte(3u * pixel), plate_byte(3u * pixel + 1u), plate_byte(3u * pixel + 2u));
    // What would be brighter than white is white in the picture.
    precise vec3 most = 255.0 * vec3(light.dim[0], light.dim[1], light.dim[2]);
    vec3 known = luminance(min(behind, most));
    float inverse = quotient(1.0, max(known.x, 4.0));
    precise vec3 off = seen - known;
    precise float lit = widths.lit - 0.5 * (off.x * off.x * widths.y + (off.y * off.y + off.z * off.z) * widths.c);
    precise float bright = seen.x * inverse;
    precise float below = light.logs[0] - (1.0 - bright) * light.falls[0];
    precise float above = light.logs[1] - (bright - 1.0) * light.falls[1];
    precise vec2 shaded = seen.yz - bright * known.yz;
    float density = bright < 1.0 ? below : above;
    precise float shadow = widths.shadow - logarithms[pixel] + density
        - 0.5 * (shaded.x * shaded.x + shaded.y * shaded.y) * widths.c;
    bool is_shadow = bright >= light.range[0] && bright <= light.range[1];
    return vec2(lit, is_shadow ? shadow : -1e4);
}

// Where the person may be: left, top, and one past right and bottom; nothing where nothing was found.
uvec4 region() {
    uvec2 size = uvec2(push.width, push.height);
    uvec2 first = size - min(uvec2(sides[0], sides[1]), size);
    uvec2 last = min(uvec2(sides[2], sides[3]) + push.motion, size);
    return sides[2] == 0u ? uvec4(0u) : uvec4(first - min(first, uvec2(push.motion)), last);
}

#endif
