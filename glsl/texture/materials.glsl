// Materials (METHOD B2) as texture/materials has them on the CPU, without tiles: the same lattice words and the same formulas in
// single precision. What a material needs is a row of numbers in the order in which the library writes them.

#ifndef TEXTURE_MATERIALS
#define TEXTURE_MATERIALS

#include "texture/noise.glsl"
#include "texture/mixed64.glsl"
#include "texture/constants.glsl"

struct Material {
    uint kind;                     // MATERIAL_*
    uint seed_low;
    uint seed_high;
    uint lattices[MATERIAL_LATTICES]; // states of the space's own lattice and of its others, from 1
    float numbers[MATERIAL_NUMBERS];
};

const float OFF_LATTICE = 0.37;

// A sum of octaves over a lattice; `sum` as in octave_part().
float material_sum(uint state, uint sum, uint count, vec3 scale, vec3 p) {
    vec3 q = p * scale + vec3(0.0, 0.0, OFF_LATTICE);
    float total = 0.0;
    float frequency = 1.0;
    float amplitude = 1.0;
    for (uint k = 0u; k < count; k++) {
        uint word;
        Lattice lattice = Lattice(false, state ^ (k * 0x9E3779B9u), ivec4(0));
        total += octave_part(sum, noise(lattice, false, 3u, vec4(q * frequency, 0.0), word)) * amplitude;
        frequency *= 2.0;
        amplitude *= 0.5;
    }
    return total;
}

// Octave k as the thesis stores it.
float material_octave(Material of, uint k, vec3 scale, vec3 p) {
    float rise = float(1u << k);
    return (1.0 + material_sum(of.lattices[k + 1u], 0u, 1u, scale * rise, p)) / (4.0 * rise);
}

// A number in [0, 1) for a cell.
float material_cell(Material of, ivec3 cell, uint die) {
    uvec2 key = uvec2(of.seed_low, of.seed_high ^ (die << 24));
    for (int axis = 0; axis < 3; axis++) {
        uvec2 index = extended64(cell[axis]);
        uint word = mixed64(key ^ index);
        key = uvec2(word, key.x ^ (index.x << 16));
    }
    return float(mixed64(key) >> 8) / 16777216.0;
}

vec3 material_numbers(Material of, int first) {
    return vec3(of.numbers[first], of.numbers[first + 1], of.numbers[first + 2]);
}

vec3 blend(vec3 a, vec3 b, float t) {
    return a + (b - a) * clamp(t, 0.0, 1.0);
}

vec3 clouds_at(Material of, vec3 p) {
    float sum = 0.0;
    for (uint k = 0u; k < 4u; k++) sum += material_octave(of, k, vec3(of.numbers[8]), p);
    return blend(material_numbers(of, 0), material_numbers(of, 3), of.numbers[7] * (sum + of.numbers[6]));
}

vec3 lava_at(Material of, vec3 p) {
    float about_means = material_sum(of.lattices[0], 1u, 4u, vec3(of.numbers[7]), p) / 4.0;
    return blend(material_numbers(of, 0), material_numbers(of, 3), of.numbers[6] * about_means);
}

vec3 marble_at(Material of, vec3 p) {
    float turbulence = material_sum(of.lattices[0], 1u, 4u, vec3(of.numbers[8]), p) / 4.0;
    float height = 0.5 * sin(6.2831853 * of.numbers[6] * p.y + of.numbers[7] * turbulence) + 0.5;
    return blend(material_numbers(of, 0), material_numbers(of, 3), height);
}

vec3 granite_at(Material of, vec3 p) {
    return material_numbers(of, 0) * clamp(of.numbers[3] * material_octave(of, 3u, vec3(of.numbers[4]), p), 0.0, 1.0);
}

// Early and late wood of rings, `rings` being how many lie inside.
vec3 rings_at(Material of, float rings) {
    float saw = 2.0 * (rings - floor(rings));
    return blend(material_numbers(of, 0), material_numbers(of, 3), saw > 1.0 ? 2.0 - saw : saw);
}

// Where in its grain a point is, from 0 to 1.
float grain_at(Material of, vec3 p) {
    float grains = p.x * of.numbers[11] + p.z * of.numbers[11] + 0.5;
    return grains - floor(grains);
}

vec3 wood_at(Material of, vec3 p) {
    vec3 n;
    for (uint k = 0u; k < 3u; k++) n[k] = of.numbers[7] * material_octave(of, k, material_numbers(of, 8), p);
    float x = p.x + n.x;
    float z = p.z + n.z;
    vec3 colour = rings_at(of, sqrt(x * x + z * z) * of.numbers[6] + n.x + n.y + n.z);
    float grain = grain_at(of, p);
    n.z *= grain;
    if (grain < of.numbers[12]) return colour + material_numbers(of, 0) * (of.numbers[13] * n.z);
    return colour - material_numbers(of, 3) * (of.numbers[14] * n.z);
}

// Wood with its noise about the mean.
vec3 timber_at(Material of, vec3 p) {
    vec3 octaves;
    for (uint k = 0u; k < 3u; k++) octaves[k] = material_octave(of, k, material_numbers(of, 8), p);
    float x = abs(p.x) + of.numbers[7] * (octaves.x - 0.25);
    float z = p.z + of.numbers[7] * (octaves.y - 0.125);
    vec3 colour = rings_at(of, sqrt(x * x + z * z) * of.numbers[6] + octaves.x + octaves.y + octaves.z);
    float grain = grain_at(of, p);
    float change = (grain < of.numbers[12] ? of.numbers[13] : -of.numbers[14]) * octaves.z * grain;
    return colour + material_numbers(of, 0) * change;
}

// 0 below `low`, 1 above `high`, a cubic between.
float material_step(float low, float high, float x) {
    float t = clamp((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

vec3 brick_at(Material of, vec3 p) {
    vec3 per_unit = material_numbers(of, 9);
    float half_joint = of.numbers[12];
    float roughness = of.numbers[13];
    float wobble = 0.03 * roughness * material_sum(of.lattices[0], 0u, 3u, vec3(6.0), p);
    float row = (p.y + wobble) * per_unit.y;
    float shift = (int(floor(row)) & 1) == 1 ? 0.5 : 0.0;
    vec3 place = vec3((p.x - wobble) * per_unit.x + shift, row, p.z * per_unit.z + 0.5);
    vec3 t = place - floor(place);
    vec3 gaps = min(t, 1.0 - t) / per_unit;
    float face = material_step(half_joint * 0.7, half_joint * 1.6, min(gaps.x, min(gaps.y, gaps.z)));
    float shade = material_cell(of, ivec3(floor(place)), 0u);
    float rough = material_sum(of.lattices[7], 0u, 4u, vec3(9.0), p);
    float sand = material_sum(of.lattices[8], 0u, 3u, vec3(22.0), p);
    vec3 clay = blend(material_numbers(of, 3), material_numbers(of, 0), shade) * (1.0 + roughness * 0.45 * rough);
    return blend(material_numbers(of, 6) * (1.0 + roughness * 0.3 * sand), clay, face);
}

vec3 fabric_at(Material of, vec3 p) {
    float threads = of.numbers[6];
    int over = int(of.numbers[7]);
    float irregularity = of.numbers[8];
    float wander = 0.18 * irregularity * material_sum(of.lattices[0], 0u, 2u, vec3(2.5), p);
    float x = (p.x + p.z) * threads + wander;
    float y = (p.y + p.z) * threads - wander;
    ivec2 cell = ivec2(floor(vec2(x, y)));
    int around = 2 * over;
    int phase = (cell.x + cell.y) - around * int(floor(float(cell.x + cell.y) / float(around)));
    bool warp_above = phase < over;
    float along = warp_above ? (y - floor(y)) + float(phase) : (x - floor(x)) + float(phase - over);
    float across = warp_above ? x - floor(x) : y - floor(y);
    float arch = sqrt(max(sin(3.14159265 * clamp(along / float(over), 0.0, 1.0)), 0.0));
    float side = 2.0 * across - 1.0;
    float height = (0.25 + 0.75 * arch) * sqrt(max(1.0 - side * side, 0.0));
    float own = material_cell(of, warp_above ? ivec3(cell.x, 0, 0) : ivec3(0, cell.y, 1), 1u) - 0.5;
    vec3 fibre = (warp_above ? vec3(5.0, 1.2, 1.0) : vec3(1.2, 5.0, 1.0)) * threads * 0.5;
    float fibres = material_sum(of.lattices[3], 0u, 3u, fibre, p);
    float shade = (0.35 + 0.65 * height) * (1.0 + irregularity * (0.5 * own + 0.35 * fibres));
    return (warp_above ? material_numbers(of, 0) : material_numbers(of, 3)) * shade;
}

// The colour at a point, sRGB 0 to 1.
vec3 material_at(Material of, vec3 p) {
    vec3 colour = vec3(0.0);
    switch (of.kind) {
        case MATERIAL_CLOUDS: colour = clouds_at(of, p); break;
        case MATERIAL_LAVA: colour = lava_at(of, p); break;
        case MATERIAL_MARBLE: colour = marble_at(of, p); break;
        case MATERIAL_GRANITE: colour = granite_at(of, p); break;
        case MATERIAL_WOOD: colour = wood_at(of, p); break;
        case MATERIAL_TIMBER: colour = timber_at(of, p); break;
        case MATERIAL_BRICK: colour = brick_at(of, p); break;
        case MATERIAL_FABRIC: colour = fabric_at(of, p); break;
    }
    return clamp(colour, 0.0, 1.0);
}

// The same as light adds up.
vec3 linear_light(vec3 colour) {
    return mix(pow((colour + 0.055) / 1.055, vec3(2.4)), colour / 12.92, lessThanEqual(colour, vec3(0.04045)));
}

#endif
