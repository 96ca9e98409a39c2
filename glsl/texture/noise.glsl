// Noise with the values of texture/noise on the CPU (METHOD B1): the same words on lattice points, the same operations in the
// same order, `precise` so that none are fused or regrouped. For any stage. Where tables shall be used, the stage defines
// NOISE_TABLE(i): 256 entries of the permutation, then 256 words.

#ifndef TEXTURE_NOISE
#define TEXTURE_NOISE

// What stands on lattice points. `state`: the mixed seed of arithmetic words, or the shift of tables. `period`: cells after
// which an axis repeats itself, 0 where it does not.
struct Lattice {
    bool tables;
    uint state;
    ivec4 period;
};

int lattice_wrapped(Lattice lattice, uint axis, int cell) {
    int period = lattice.period[axis];
    if (period < 1) return cell;
    // The remainder of negative numbers is not defined in GLSL; ~cell = -1 - cell.
    if (cell >= 0) return cell % period;
    return period - 1 - (~cell) % period;
}

uint lattice_first(Lattice lattice, int cell) {
#ifdef NOISE_TABLE
    if (lattice.tables) return NOISE_TABLE((uint(cell) + lattice.state) & 255u);
#endif
    return lattice.state ^ (uint(cell) * 0x9E3779B1u);
}

uint lattice_join(Lattice lattice, uint share, uint axis, int cell) {
#ifdef NOISE_TABLE
    if (lattice.tables) return NOISE_TABLE((share + uint(cell)) & 255u);
#endif
    uint factor = axis == 1u ? 0x85EBCA77u : (axis == 2u ? 0xC2B2AE3Du : 0x27D4EB2Fu);
    return share ^ (uint(cell) * factor);
}

uint lattice_word(Lattice lattice, uint share) {
#ifdef NOISE_TABLE
    if (lattice.tables) return NOISE_TABLE(256u + (share & 255u));
#endif
    return (share ^ (share >> 15)) * 0x2C1B3C6Du;
}

// Cell and place in it. Cells saturate: the conversion of larger numbers is not defined in GLSL.
int noise_split(float x, out float t) {
    float whole = floor(x);
    precise float rest = x - whole;
    t = rest;
    if (whole >= 2147483648.0) return 0x7FFFFFFF;
    if (whole <= -2147483648.0) return -0x7FFFFFFF - 1;
    return int(whole);
}

// The cells on both sides.
ivec2 noise_sides(Lattice lattice, uint axis, int cell) {
    int next = int(uint(cell) + 1u);
    return ivec2(lattice_wrapped(lattice, axis, cell), lattice_wrapped(lattice, axis, next));
}

float quintic(float t) {
    precise float faded = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    return faded;
}

float cubic(float t) {
    precise float faded = t * t * (3.0 - 2.0 * t);
    return faded;
}

float noise_mix(float a, float b, float t) {
    precise float mixed = a + (b - a) * t;
    return mixed;
}

float signed_by(float value, uint word) {
    return uintBitsToFloat(floatBitsToUint(value) ^ (word & 0x80000000u));
}

float slope1(uint word, float x) {
    precise float slope = (float(int(word >> 8)) * (1.0 / 4194304.0) - 2.0) * x;
    return slope;
}

float slope2(uint word, float x, float y) {
    bool steep = (word & 0x20000000u) != 0u;
    precise float u = (steep ? y : x) * 1.306563;
    precise float v = (steep ? x : y) * 0.5411961;
    precise float sum = signed_by(u, word) + signed_by(v, word << 1);
    return sum;
}

float slope3(uint word, float x, float y, float z) {
    uint pair = word & 0x3FFFFFFFu;
    float u = pair < 0x15555555u ? y : x;
    float v = pair < 0x2AAAAAAAu ? z : y;
    precise float sum = signed_by(u, word) + signed_by(v, word << 1);
    return sum;
}

float slope4(uint word, float x, float y, float z, float w) {
    uint left_out = (word >> 27) & 3u;
    float a = left_out == 0u ? y : x;
    float b = left_out <= 1u ? z : y;
    float c = left_out <= 2u ? w : z;
    precise float sum = ((signed_by(a, word) + signed_by(b, word << 1)) + signed_by(c, word << 2)) * (2.0 / 3.0);
    return sum;
}

float value_number(uint word) {
    precise float number = float(int(word >> 8)) * (1.0 / 8388608.0) - 1.0;
    return number;
}

// What a corner contributes to gradient noise; `p` is the point as seen from it.
float perlin_corner(uint dimensions, uint word, vec4 p) {
    if (dimensions == 1u) return slope1(word, p.x);
    if (dimensions == 2u) return slope2(word, p.x, p.y);
    if (dimensions == 3u) return slope3(word, p.x, p.y, p.z);
    return slope4(word, p.x, p.y, p.z, p.w);
}

// What corner `away` from the point's cell holds, seen from the point at `t` in the cell.
float noise_corner(Lattice lattice, bool value, uint dimensions, uint share, vec4 t, vec4 away) {
    uint word = lattice_word(lattice, share);
    precise vec4 seen = t - away;
    return value ? value_number(word) : perlin_corner(dimensions, word, seen);
}

// The four corners of a cell's face along x and y, mixed; `away` is its place along z and w.
float noise_face(Lattice lattice, bool value, uint dimensions, uvec4 shares, vec4 t, vec4 fade, vec2 away) {
    float a = noise_corner(lattice, value, dimensions, shares.x, t, vec4(0.0, 0.0, away));
    float b = noise_corner(lattice, value, dimensions, shares.y, t, vec4(1.0, 0.0, away));
    float low = noise_mix(a, b, fade.x);
    if (dimensions == 1u) return low;
    float c = noise_corner(lattice, value, dimensions, shares.z, t, vec4(0.0, 1.0, away));
    float d = noise_corner(lattice, value, dimensions, shares.w, t, vec4(1.0, 1.0, away));
    return noise_mix(low, noise_mix(c, d, fade.x), fade.y);
}

uvec4 lattice_join4(Lattice lattice, uvec4 shares, uint axis, int cell) {
    return uvec4(lattice_join(lattice, shares.x, axis, cell), lattice_join(lattice, shares.y, axis, cell),
        lattice_join(lattice, shares.z, axis, cell), lattice_join(lattice, shares.w, axis, cell));
}

// Gradient noise (or value noise) of 1 to 4 dimensions; `word` is that of the point's cell.
float noise(Lattice lattice, bool value, uint dimensions, vec4 p, out uint word) {
    vec4 t = vec4(0.0);
    float place;
    ivec2 x = noise_sides(lattice, 0u, noise_split(p.x, place));
    t.x = place;
    ivec2 y = ivec2(0), z = ivec2(0), w = ivec2(0);
    if (dimensions > 1u) {
        y = noise_sides(lattice, 1u, noise_split(p.y, place));
        t.y = place;
    }
    if (dimensions > 2u) {
        z = noise_sides(lattice, 2u, noise_split(p.z, place));
        t.z = place;
    }
    if (dimensions > 3u) {
        w = noise_sides(lattice, 3u, noise_split(p.w, place));
        t.w = place;
    }
    vec4 fade = value ? vec4(cubic(t.x), cubic(t.y), cubic(t.z), cubic(t.w))
                      : vec4(quintic(t.x), quintic(t.y), quintic(t.z), quintic(t.w));
    uvec4 shares = uvec4(lattice_first(lattice, x.x), lattice_first(lattice, x.y), 0u, 0u);
    shares.zw = shares.xy;
    if (dimensions > 1u) {
        shares = uvec4(lattice_join(lattice, shares.x, 1u, y.x), lattice_join(lattice, shares.y, 1u, y.x),
            lattice_join(lattice, shares.x, 1u, y.y), lattice_join(lattice, shares.y, 1u, y.y));
    }
    if (dimensions < 3u) {
        word = lattice_word(lattice, shares.x);
        return noise_face(lattice, value, dimensions, shares, t, fade, vec2(0.0));
    }
    uvec4 near = lattice_join4(lattice, shares, 2u, z.x);
    uvec4 far = lattice_join4(lattice, shares, 2u, z.y);
    if (dimensions == 3u) {
        word = lattice_word(lattice, near.x);
        float front = noise_face(lattice, value, dimensions, near, t, fade, vec2(0.0));
        float back = noise_face(lattice, value, dimensions, far, t, fade, vec2(1.0, 0.0));
        return noise_mix(front, back, fade.z);
    }
    uvec4 now = lattice_join4(lattice, near, 3u, w.x);
    word = lattice_word(lattice, now.x);
    float a = noise_face(lattice, value, dimensions, now, t, fade, vec2(0.0));
    float b = noise_face(lattice, value, dimensions, lattice_join4(lattice, far, 3u, w.x), t, fade, vec2(1.0, 0.0));
    float c = noise_face(lattice, value, dimensions, lattice_join4(lattice, near, 3u, w.y), t, fade, vec2(0.0, 1.0));
    float d = noise_face(lattice, value, dimensions, lattice_join4(lattice, far, 3u, w.y), t, fade, vec2(1.0, 1.0));
    return noise_mix(noise_mix(a, b, fade.z), noise_mix(c, d, fade.z), fade.w);
}

// What an octave adds before its amplitude: the noise itself, its absolute value, or its ridge.
float octave_part(uint sum, float n) {
    precise float ridge = (1.0 - abs(n)) * (1.0 - abs(n));
    return sum == 0u ? n : (sum == 1u ? abs(n) : ridge);
}

#endif
