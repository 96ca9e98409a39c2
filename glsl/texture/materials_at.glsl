// The look-up of materials: see materials.glsl.

#ifndef TEXTURE_MATERIALS_AT
#define TEXTURE_MATERIALS_AT

#include "texture/materials.glsl"
#include "texture/noise.glsl"

const float OFF_LATTICE = 0.37;

// Colour, sRGB, and height.
struct Texel {
    vec3 colour;
    float height;
};

float material_number(uint of, uint i) {
    return MATERIAL(of).numbers[i];
}

vec3 material_numbers(uint of, uint first) {
    return vec3(material_number(of, first), material_number(of, first + 1u), material_number(of, first + 2u));
}

vec2 material_pair(uint of, uint first) {
    return vec2(material_number(of, first), material_number(of, first + 1u));
}

// A sum of octaves, as `sums` of Material says it.
float material_sum(uint of, uint sum, vec3 p) {
    uint first = sum & 255u;
    uint count = (sum >> 8) & 255u;
    precise float total = 0.0;
    for (uint k = first; k < first + count; k++) {
        precise vec3 scaled = p * MATERIAL(of).octaves[k].scale;
        precise vec3 at = vec3(scaled.xy, scaled.z + OFF_LATTICE);
        precise vec3 q = at * MATERIAL(of).octaves[k].frequency;
        uint state = MATERIAL(of).octaves[k].state;
        ivec4 period = ivec4(MATERIAL(of).octaves[k].period, 0);
#ifdef NOISE_WAY
        float n = noise_in_a_way(state, period, q);
#else
        uint word;
        float n = noise(Lattice(false, state, period), false, 3u, vec4(q, 0.0), word);
#endif
        precise float part = octave_part(sum >> 16, n) * MATERIAL(of).octaves[k].amplitude;
        total = total + part;
    }
    return total;
}

// Octaves 0 to 3 as the thesis stores them, from their noise.
vec4 octaves_of(vec4 noise) {
    precise vec4 octaves = (1.0 + noise) * vec4(0.25, 0.125, 0.0625, 0.03125);
    return octaves;
}

// The cell that a coordinate in cells lies in, the last ones of their type beyond it.
int cell_of(float x) {
    float rest;
    return noise_split(x, rest);
}

ivec3 cells_of(vec3 x) {
    return ivec3(cell_of(x.x), cell_of(x.y), cell_of(x.z));
}

// A number in [0, 1) for a cell, by one of the material's dice; `cells` is how many there are a tile along x and y, 0 without one.
float material_cell(uint of, uint dice, ivec3 cell, vec2 cells, uint die) {
    Lattice repeated = Lattice(false, 0u, ivec4(cell_of(cells.x), cell_of(cells.y), 0, 0));
    uvec2 key = MATERIAL(of).dice[dice] ^ uvec2(0u, die << 24);
    for (uint axis = 0u; axis < 3u; axis++) {
        uvec2 index = extended64(lattice_wrapped(repeated, axis, cell[axis]));
        uint word = mixed64(key ^ index);
        key = uvec2(word, key.x ^ (index.x << 16));
    }
    return float(mixed64(key) >> 8) * (1.0 / 16777216.0);
}

vec3 blend(vec3 a, vec3 b, float t) {
    precise vec3 blended = a + (b - a) * clamp(t, 0.0, 1.0);
    return blended;
}

vec3 dimmed(vec3 colour, float factor) {
    precise vec3 product = colour * factor;
    return product;
}

// 0 below `low`, 1 above `high`, a cubic between.
float material_step(float low, float high, float x) {
    precise float above = x - low;
    precise float width = high - low;
    float t = clamp(quotient(above, max(width, 1e-6)), 0.0, 1.0);
    return cubic(t);
}

Texel clouds_at(uint of, vec4 sums) {
    vec4 octaves = octaves_of(sums);
    precise float sum = octaves.x + octaves.y + octaves.z + octaves.w;
    precise float height = material_number(of, 7u) * (sum + material_number(of, 6u));
    return Texel(blend(material_numbers(of, 0u), material_numbers(of, 3u), height), height);
}

Texel lava_at(uint of, vec4 sums) {
    precise float turbulence = material_number(of, 6u) * (sums.x * 0.25);
    float height = clamp(turbulence, 0.0, 1.0);
    return Texel(blend(material_numbers(of, 0u), material_numbers(of, 3u), height), height);
}

Texel marble_at(uint of, vec3 p, vec4 sums) {
    precise float turbulence = sums.x * 0.25;
    precise float turns = material_number(of, 6u) * p.y + material_number(of, 7u) * turbulence;
    precise float height = 0.5 * sine_of_turns(turns) + 0.5;
    return Texel(blend(material_numbers(of, 0u), material_numbers(of, 3u), height), height);
}

Texel granite_at(uint of, vec4 sums) {
    precise float grains = material_number(of, 3u) * octaves_of(sums.xxxx).w;
    float height = clamp(grains, 0.0, 1.0);
    return Texel(dimmed(material_numbers(of, 0u), height), height);
}

// How far in its year a point lies, by the rings from the middle to it.
float season(float rings) {
    precise float saw = 2.0 * (rings - floor(rings));
    precise float falling = 2.0 - saw;
    return saw > 1.0 ? falling : saw;
}

// Where in its grain a point is, from 0 to 1.
float grain_at(uint of, vec3 p) {
    precise float grains = p.x * material_number(of, 8u) + p.z * material_number(of, 9u) + 0.5;
    precise float grain = grains - floor(grains);
    return grain;
}

// How far a point is from x = 0, or from the nearest repetition of it.
float across_trunks(uint of, float x) {
    float half_turns = material_number(of, 13u);
    precise float turns = x * half_turns;
    precise float reach = abs(sine_of_turns(turns)) * material_number(of, 14u);
    return half_turns > 0.0 ? reach : abs(x);
}

Texel wood_at(uint of, vec3 p, vec4 sums) {
    precise vec3 n = octaves_of(sums).xyz;
    n = material_number(of, 7u) * n;
    precise float x = (material_number(of, 13u) > 0.0 ? across_trunks(of, p.x) : p.x) + n.x;
    precise float z = p.z + n.z;
    precise float square = x * x + z * z;
    precise float rings = square_root(square) * material_number(of, 6u) + (n.x + n.y + n.z);
    float ring = season(rings);
    vec3 colour = blend(material_numbers(of, 0u), material_numbers(of, 3u), ring);
    float grain = grain_at(of, p);
    precise float strength = n.z * grain;
    bool is_light = grain < material_number(of, 10u);
    vec3 tone = is_light ? material_numbers(of, 0u) : material_numbers(of, 3u);
    precise float change = (is_light ? material_number(of, 11u) : -material_number(of, 12u)) * strength;
    precise vec3 changed = colour + tone * change;
    precise float height = 1.0 - ring + change;
    return Texel(changed, height);
}

Texel timber_at(uint of, vec3 p, vec4 sums) {
    precise vec3 n = octaves_of(sums).xyz;
    precise float x = across_trunks(of, p.x) + material_number(of, 7u) * (n.x - 0.25);
    precise float z = p.z + material_number(of, 7u) * (n.y - 0.125);
    precise float square = x * x + z * z;
    precise float rings = square_root(square) * material_number(of, 6u) + (n.x + n.y + n.z);
    float ring = season(rings);
    vec3 colour = blend(material_numbers(of, 0u), material_numbers(of, 3u), ring);
    float grain = grain_at(of, p);
    precise float strength = n.z * grain;
    precise float change = (grain < material_number(of, 10u) ? material_number(of, 11u) : -material_number(of, 12u)) * strength;
    precise vec3 changed = colour + material_numbers(of, 0u) * change;
    precise float height = 1.0 - ring + change;
    return Texel(changed, height);
}

Texel brick_at(uint of, vec3 p, vec4 sums) {
    vec3 per_unit = material_numbers(of, 9u);
    float half_joint = material_number(of, 15u);
    float roughness = material_number(of, 16u);
    precise float wobble = 0.03 * roughness * sums.x;
    precise float row = (p.y + wobble) * per_unit.y;
    float shift = (cell_of(row) & 1) == 1 ? 0.5 : 0.0;
    precise float along = (p.x - wobble) * per_unit.x + shift;
    precise float deep = p.z * per_unit.z + 0.5;
    vec3 place = vec3(along, row, deep);
    precise vec3 t = place - floor(place);
    precise vec3 gaps = min(t, 1.0 - t) * material_numbers(of, 12u);
    precise float inner = half_joint * 0.7;
    precise float outer = half_joint * 1.6;
    float face = material_step(inner, outer, min(gaps.x, min(gaps.y, gaps.z)));
    float shade = material_cell(of, 0u, cells_of(place), material_pair(of, 17u), 0u);
    float rough = sums.y;
    precise float clay_light = 1.0 + roughness * 0.45 * rough;
    vec3 clay = dimmed(blend(material_numbers(of, 3u), material_numbers(of, 0u), shade), clay_light);
    precise float sand_light = 1.0 + roughness * 0.3 * sums.z;
    vec3 sand = dimmed(material_numbers(of, 6u), sand_light);
    precise float height = face * (0.75 + 0.15 * shade + 0.2 * roughness * rough) + 0.15;
    return Texel(blend(sand, clay, face), height);
}

// Where a point of cloth lies: in which threads, how far across the upper one, and along it from where it comes up to where it dives.
struct Weave {
    int column;
    int row;
    bool warp_above;
    float beside;
    float ahead;
};

Weave weave_at(uint of, vec3 p, float noise) {
    vec2 per_unit = material_pair(of, 6u);
    int over = int(material_number(of, 8u));
    precise float wander = 0.18 * material_number(of, 10u) * noise;
    precise float x = (p.x + p.z) * per_unit.x + wander;
    precise float y = (p.y + p.z) * per_unit.y - wander;
    int column = cell_of(x);
    int row = cell_of(y);
    // The sum wraps around.
    Lattice weave = Lattice(false, 0u, ivec4(2 * over));
    int phase = lattice_wrapped(weave, 0u, int(uint(column) + uint(row)));
    bool warp_above = phase < over;
    precise float beside = warp_above ? x - floor(x) : y - floor(y);
    precise float ahead = warp_above ? (y - floor(y)) + float(phase) : (x - floor(x)) + float(phase - over);
    return Weave(column, row, warp_above, beside, ahead);
}

Texel fabric_at(uint of, vec3 p, vec4 sums) {
    float irregularity = material_number(of, 10u);
    Weave at = weave_at(of, p, sums.x);
    precise float along = 0.5 * clamp(at.ahead * material_number(of, 9u), 0.0, 1.0);
    float arch = square_root(max(sine_of_turns(along), 0.0));
    precise float side = 2.0 * at.beside - 1.0;
    precise float within = 1.0 - side * side;
    float profile = square_root(max(within, 0.0));
    precise float height = (0.25 + 0.75 * arch) * profile;
    ivec3 thread = at.warp_above ? ivec3(at.column, 0, 0) : ivec3(0, at.row, 1);
    precise float own = material_cell(of, 0u, thread, material_pair(of, 11u), 1u) - 0.5;
    precise float shade = (0.35 + 0.65 * height) * (1.0 + irregularity * (0.5 * own + 0.35 * sums.y));
    return Texel(dimmed(at.warp_above ? material_numbers(of, 0u) : material_numbers(of, 3u), shade), height);
}

#ifdef MATERIAL_TABLES
#include "texture/materials_pictures.glsl"
#endif

// How many sums of noise a material of a kind takes.
uint sums_of(uint kind) {
    switch (kind) {
        case MATERIAL_CLOUDS: return 4u;
        case MATERIAL_WOOD: case MATERIAL_TIMBER: case MATERIAL_BRICK: case MATERIAL_SKIN: case MATERIAL_TERRAIN: return 3u;
        case MATERIAL_FABRIC: return 2u;
        case MATERIAL_FRACTAL: return 0u;
    }
    return 1u;
}

// The sums of noise at a point. All materials come here, so that noise stands in the code once.
vec4 material_sums(uint kind, uint of, vec3 p) {
    vec4 sums = vec4(0.0);
    uint count = sums_of(kind);
    for (uint i = 0u; i < count; i++) {
        uint row = i;
        vec3 at = p;
        // Fibres lie along the upper thread, and which that is the first sum tells.
        if (kind == MATERIAL_FABRIC && i == 1u) row = weave_at(of, p, sums.x).warp_above ? 1u : 2u;
#ifdef MATERIAL_TABLES
        // A height here and those of its neighbours.
        if (kind == MATERIAL_TERRAIN) {
            row = 0u;
            at = neighbour_of(of, p, i);
        }
#endif
        sums[i] = material_sum(of, MATERIAL(of).sums[row], at);
    }
    return sums;
}

// What a material of a kind is at a point.
Texel texel_at(uint kind, uint of, vec3 point) {
    vec3 p = clamp(point, -1e6, 1e6);
    vec4 sums = material_sums(kind, of, p);
    Texel texel = Texel(vec3(0.0), 0.0);
    switch (kind) {
        case MATERIAL_CLOUDS: texel = clouds_at(of, sums); break;
        case MATERIAL_LAVA: texel = lava_at(of, sums); break;
        case MATERIAL_MARBLE: texel = marble_at(of, p, sums); break;
        case MATERIAL_GRANITE: texel = granite_at(of, sums); break;
        case MATERIAL_WOOD: texel = wood_at(of, p, sums); break;
        case MATERIAL_TIMBER: texel = timber_at(of, p, sums); break;
        case MATERIAL_BRICK: texel = brick_at(of, p, sums); break;
        case MATERIAL_FABRIC: texel = fabric_at(of, p, sums); break;
#ifdef MATERIAL_TABLES
        case MATERIAL_GRASS: texel = grass_at(of, p, sums); break;
        case MATERIAL_SKIN: texel = skin_at(of, p, sums); break;
        case MATERIAL_FRACTAL: texel = fractal_at(of, p); break;
        case MATERIAL_TERRAIN: texel = terrain_at(of, sums); break;
#endif
    }
    return Texel(clamp(texel.colour, 0.0, 1.0), clamp(texel.height, 0.0, 1.0));
}

float linear_part(float c) {
    precise float small = c * 0.07739938;
    precise float base = (c + 0.055) * 0.9478673;
    return c <= 0.04045 ? small : real_power(base, 2.4);
}

// A colour as light adds up.
vec3 linear_light(vec3 colour) {
    return vec3(linear_part(colour.r), linear_part(colour.g), linear_part(colour.b));
}

#endif
