// A sum of octaves of noise (METHOD B1) as a request describes it. Octaves come from the library: frequencies of tiles are
// rounded there, once.

#ifndef TEXTURE_OCTAVES
#define TEXTURE_OCTAVES

#include "texture/constants.glsl"

struct Octave {
    vec4 frequency;
    ivec4 period;
    float amplitude;
    uint state;
};

layout(std430, set = 0, binding = 0) readonly buffer Points { vec4 points[]; };
layout(std430, set = 0, binding = 1) readonly buffer AllOctaves { Octave octaves[]; };
layout(std430, set = 0, binding = 2) readonly buffer Tables { uint tables[]; };

// 1 to 4.
layout(constant_id = 0) const uint DIMENSIONS = 3u;
// 0 gradient noise, 1 value noise.
layout(constant_id = 1) const uint KIND = 0u;
// 0 fbm, 1 turbulence, 2 ridged.
layout(constant_id = 2) const uint SUM = 0u;
// 0 arithmetic, 1 tables.
layout(constant_id = 3) const uint SOURCE = 0u;

#define NOISE_TABLE(i) tables[i]
#include "texture/noise.glsl"

// The sum of so many octaves at a point, and the lattice's word at the point's cell in the first.
float octave_sum(vec4 point, uint count, out uint first_word) {
    uint dimensions = DIMENSIONS;
    uint kind = KIND;
    uint sum = SUM;
    uint source = SOURCE;
    float farthest = uintBitsToFloat(FARTHEST_BITS);
    vec4 p = clamp(point, vec4(-farthest), vec4(farthest));
    precise float total = 0.0;
    first_word = 0u;
    for (uint k = 0u; k < count; k++) {
        Octave octave = octaves[k];
        Lattice lattice = Lattice(source == 1u, octave.state, octave.period);
        precise vec4 q = p * octave.frequency;
        uint word = 0u;
        float n = noise(lattice, kind == 1u, dimensions, q, word);
        precise float part = octave_part(sum, n) * octave.amplitude;
        total = total + part;
        if (k == 0u) first_word = word;
    }
    return total;
}

#endif
