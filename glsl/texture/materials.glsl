// Materials (METHOD B2) as texture/materials has them on the processor, with its bits: the same lattice words, the same formulas in the
// same order, `precise`, quotients and roots rounded as processors round them. What a material needs is a row of numbers and of
// octaves in the order in which the library writes them. materials_at.glsl looks them up: before it a stage defines MATERIAL(of), the
// Material of a number.

#ifndef TEXTURE_MATERIALS
#define TEXTURE_MATERIALS

#include "arithmetic/elementary.glsl"
#include "arithmetic/rounding.glsl"
#include "texture/mixed64.glsl"
#include "texture/constants.glsl"

// An octave of a sum of noise.
struct NoiseOctave {
    vec3 scale;     // of lengths, of the whole sum
    uint state;     // of the lattice
    vec3 frequency; // cells a scaled unit
    float amplitude;
    ivec3 period;   // cells, 0 where it does not repeat
};

struct Material {
    uint kind;    // MATERIAL_*
    uvec2 dice[3]; // seeds of its space, of another, of one more
    float numbers[MATERIAL_NUMBERS];
    // Sums of noise: the first octave, how many (from bit 8), what is summed (from bit 16; as in octave_part()).
    uint sums[MATERIAL_SUMS];
    NoiseOctave octaves[MATERIAL_OCTAVES];
};

#endif
