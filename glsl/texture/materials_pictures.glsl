// Materials that pictures show and scenes do not; part of materials_at.glsl. MATERIAL_TABLES(i): four numbers a band of colour, from
// which height on and which, then the heights of a surface.

Texel grass_at(uint of, vec3 p, vec4 sums) {
    const uint BLADES = 6u;
    const float TURNS = 0.15915494;
    vec2 cells = material_pair(of, 11u);
    precise vec2 at = p.xy * material_pair(of, 9u);
    precise float depth = p.z * material_number(of, 13u) * 0.25;
    int layer = cell_of(depth);
    vec2 base = floor(at);
    ivec2 own = ivec2(cell_of(at.x), cell_of(at.y));
    float best_order = -1.0, best_along = 0.0, best_across = 0.0, best_dry = 0.0;
    for (int dy = -2; dy <= 1; dy++) {
        for (int dx = -2; dx <= 2; dx++) {
            ivec3 cell = ivec3(int(uint(own.x) + uint(dx)), int(uint(own.y) + uint(dy)), layer);
            for (uint blade = 0u; blade < BLADES; blade++) {
                uint first = 8u * blade;
                precise float root_x = base.x + float(dx) + material_cell(of, 0u, cell, cells, first);
                precise float root_y = base.y + float(dy) + material_cell(of, 0u, cell, cells, first + 1u);
                precise float angle = (2.0 * material_cell(of, 0u, cell, cells, first + 2u) - 1.0) * material_number(of, 16u);
                precise float reach = material_number(of, 14u) * (0.5 + 0.5 * material_cell(of, 0u, cell, cells, first + 3u));
                precise float from_x = at.x - root_x;
                precise float from_y = at.y - root_y;
                precise float turns = angle * TURNS;
                precise float quarter_on = turns + 0.25;
                float sine = sine_of_turns(turns);
                float cosine = sine_of_turns(quarter_on);
                precise float ahead = from_x * sine + from_y * cosine;
                float along = quotient(ahead, max(reach, 1e-3));
                if (!(along >= 0.0 && along <= 1.0)) continue;
                precise float bend = 0.35 * angle * along * along * reach;
                precise float across = from_x * cosine - from_y * sine - bend;
                precise float half_width = 0.5 * material_number(of, 15u) * (1.0 - along * along);
                if (abs(across) > half_width) continue;
                float order = material_cell(of, 0u, cell, cells, first + 4u);
                if (order > best_order) {
                    best_order = order;
                    best_along = along;
                    best_across = across;
                    best_dry = material_cell(of, 0u, cell, cells, first + 5u);
                }
            }
        }
    }
    precise float patch_light = 0.5 + 0.5 * sums.x;
    if (best_order < 0.0) {
        precise float ground = 0.5 + 0.4 * patch_light;
        return Texel(dimmed(material_numbers(of, 0u), ground), 0.0);
    }
    precise float dryness = (best_dry - 0.75 + 0.5 * (patch_light - 0.5)) * 3.0;
    vec3 green = blend(material_numbers(of, 3u), material_numbers(of, 6u), dryness);
    precise float rise = 0.2 + 0.45 * best_order + 0.45 * best_along;
    vec3 colour = blend(material_numbers(of, 0u), green, rise);
    precise float light = (best_across > 0.0 ? 1.1 : 0.88) * (0.8 + 0.35 * patch_light);
    precise float height = 0.2 + 0.5 * best_order + 0.3 * best_along;
    return Texel(dimmed(colour, light), height);
}

// Distance in cells from a point to the nearest jittered point of a lattice of space, and a number of that point's own. `first`:
// where the material's numbers of that lattice begin, `dice`: its dice.
vec2 nearest_place(uint of, uint first, uint dice, vec3 p) {
    vec2 cells = material_pair(of, first + 3u);
    precise vec3 place = p * material_numbers(of, first);
    vec3 base = floor(place);
    ivec3 middle = cells_of(place);
    float closest = uintBitsToFloat(0x7F7FFFFFu);
    float own = 0.0;
    for (int index = 0; index < 27; index++) {
        ivec3 off = ivec3(index % 3 - 1, index / 3 % 3 - 1, index / 9 - 1);
        vec3 corner = base + vec3(off);
        ivec3 cell = cells_of(corner);
        precise vec3 jittered = corner
            + vec3(material_cell(of, dice, cell, cells, 0u), material_cell(of, dice, cell, cells, 1u),
                   material_cell(of, dice, cell, cells, 2u));
        precise vec3 away = jittered - place;
        precise float square = away.x * away.x + away.y * away.y + away.z * away.z;
        if (square < closest) {
            closest = square;
            own = material_cell(of, dice, cell, cells, 3u);
        }
    }
    return vec2(square_root(closest), own);
}

Texel skin_at(uint of, vec3 p, vec4 sums) {
    float broad = sums.x;
    float fine = sums.y;
    precise float blood = material_number(of, 9u) * (0.42 + 0.75 * broad + 0.3 * fine);
    vec3 colour = blend(material_numbers(of, 0u), material_numbers(of, 3u), blood);
    vec2 freckle = nearest_place(of, 11u, 1u, p);
    if (freckle.y < material_number(of, 10u)) {
        precise float size = 0.12 + 0.9 * freckle.y;
        precise float ragged = freckle.x + 0.12 * fine;
        precise float middle = size * 0.5;
        precise float strength = 0.75 * (1.0 - material_step(middle, size, ragged));
        colour = blend(colour, material_numbers(of, 6u), strength);
    }
    vec2 hole = nearest_place(of, 16u, 2u, p);
    precise float rim = 0.34 + 0.15 * hole.y;
    precise float pore = 1.0 - material_step(0.08, rim, hole.x);
    precise float relief = 1.0 - 0.14 * pore + 0.07 * sums.z;
    precise float height = relief - 0.3;
    return Texel(dimmed(colour, relief), height);
}

// The colour of a place of a map, from the heights of itself and its neighbours to the right (x) and up (y).
vec3 map_colour(uint of, float height, float right, float up) {
    uint bands = uint(material_number(of, 7u));
    vec3 colour = vec3(height);
    for (uint k = 0u; k < bands; k++) {
        vec3 own = vec3(MATERIAL_TABLES(4u * k + 1u), MATERIAL_TABLES(4u * k + 2u), MATERIAL_TABLES(4u * k + 3u));
        if (k == 0u) colour = own;
        float from = MATERIAL_TABLES(4u * k);
        if (k + 1u < bands && height >= from) {
            uint next = 4u * k + 4u;
            vec3 following = vec3(MATERIAL_TABLES(next + 1u), MATERIAL_TABLES(next + 2u), MATERIAL_TABLES(next + 3u));
            precise float above = height - from;
            precise float width = MATERIAL_TABLES(next) - from;
            colour = blend(own, following, quotient(above, max(width, 1e-6)));
        }
    }
    precise vec2 slope = (vec2(right, up) - height) * material_number(of, 6u);
    if (height > material_number(of, 0u)) {
        precise float light = (slope.x - slope.y) * 0.8;
        precise float size = 1.0 + abs(light);
        precise float shade = 1.0 + material_number(of, 4u) * quotient(light, size);
        colour = dimmed(colour, shade);
    }
    if (material_number(of, 2u) > 0.0) {
        precise float level = height * material_number(of, 1u);
        precise float nearest_line = floor(level + 0.5);
        precise float away = abs(level - nearest_line) * material_number(of, 2u);
        precise float square = slope.x * slope.x + slope.y * slope.y;
        precise float width = max(square_root(square), 1e-4) * material_number(of, 3u);
        precise float covered = 1.5 - quotient(away, width);
        colour = blend(colour, dimmed(colour, 0.3), covered);
    }
    return colour;
}

// Weights of four points about a place between the middle two (Catmull and Rom).
vec4 cubic_weights(float t) {
    precise float t2 = t * t;
    precise float t3 = t * t * t;
    precise vec4 weights = vec4(0.5 * (-t3 + 2.0 * t2 - t), 0.5 * (3.0 * t3 - 5.0 * t2 + 2.0), 0.5 * (-3.0 * t3 + 4.0 * t2 + t),
                                0.5 * (t3 - t2));
    return weights;
}

float surface_height(uint of, float x, float y) {
    float side = material_number(of, 8u);
    precise vec2 in_repetition = vec2(x - floor(x), y - floor(y));
    precise vec2 at = in_repetition * side;
    vec2 point = floor(at);
    precise vec2 t = at - point;
    vec4 wx = cubic_weights(t.x);
    vec4 wy = cubic_weights(t.y);
    uint points = uint(side);
    uint heights = 4u * uint(material_number(of, 7u));
    uvec2 before = uvec2(point) + points - 1u;
    precise float sum = 0.0;
    for (uint j = 0u; j < 4u; j++) {
        uint row = heights + (before.y + j) % points * points;
        precise float along = wx[0] * MATERIAL_TABLES(row + before.x % points);
        for (uint i = 1u; i < 4u; i++) along = along + wx[i] * MATERIAL_TABLES(row + (before.x + i) % points);
        sum = sum + wy[j] * along;
    }
    return clamp(sum, 0.0, 1.0);
}

// A point, or its neighbour to the right or up.
vec3 neighbour_of(uint of, vec3 p, uint number) {
    precise vec2 further = p.xy + material_number(of, 5u);
    return vec3(number == 1u ? further.x : p.x, number == 2u ? further.y : p.y, p.z);
}

Texel fractal_at(uint of, vec3 p) {
    float heights[3];
    for (uint i = 0u; i < 3u; i++) {
        vec3 at = neighbour_of(of, p, i);
        precise vec2 sheared = (at.xy + vec2(0.7, 0.4) * at.z) * vec2(material_number(of, 9u), material_number(of, 10u));
        heights[i] = surface_height(of, sheared.x, sheared.y);
    }
    return Texel(map_colour(of, heights[0], heights[1], heights[2]), max(heights[0], material_number(of, 0u)));
}

float height_of_noise(uint of, float total) {
    uint sum = MATERIAL(of).sums[0] >> 16;
    precise float lifted = 0.5 + 0.55 * total;
    precise float ridges = 0.5 * total;
    return clamp(sum == 0u ? lifted : (sum == 1u ? total : ridges), 0.0, 1.0);
}

Texel terrain_at(uint of, vec4 sums) {
    float here = height_of_noise(of, sums.x);
    vec3 colour = map_colour(of, here, height_of_noise(of, sums.y), height_of_noise(of, sums.z));
    return Texel(colour, max(here, material_number(of, 0u)));
}
