// Whether a pixel is the background in another light: src/features/shadow.rs, operation by operation.

#ifndef FEATURES_SHADOW
#define FEATURES_SHADOW

#include "arithmetic/rounding.glsl"

float product(vec3 a, vec3 b) {
    precise float sum = a.x * b.x + a.y * b.y + a.z * b.z;
    return sum;
}

bool covers(vec3 seen, vec3 background, float darkest, float brightest, float chroma_squared) {
    float along = product(seen, background);
    precise float length_squared = product(background, background) + 1e-3;
    float brightness = quotient(along, length_squared);
    precise float off_colour = product(seen, seen) - brightness * along;
    return brightness >= darkest && brightness <= brightest && off_colour <= chroma_squared;
}

#endif
