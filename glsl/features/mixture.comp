#version 450
#extension GL_GOOGLE_include_directive : require

// One picture's step of the mixtures of a band of rows (METHOD A5.1): src/features/mixture.rs, operation by operation.

#include "features/constants.glsl"
#include "features/shadow.glsl"
#include "arithmetic/elementary.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Colours { uint colours[]; };
layout(std430, set = 0, binding = 1) readonly buffer Gains { uint gains[]; };
layout(std430, set = 0, binding = 2) readonly buffer Rates {
    float alpha;
    uint first; // whether nothing was seen before
} rates;
// By component, field, pixel.
layout(std430, set = 0, binding = 3) buffer State { float state[]; };
layout(std430, set = 0, binding = 4) writeonly buffer Foreground { uint foreground[]; };

layout(push_constant) uniform Mixture {
    uint width;
    uint rows; // of the band
    uint first_row;
    uint stride;
    float match_squared;
    float background_weight;
    float initial_variance;
    float initial_weight;
    float least_variance;
    uint suppress; // whether shadows are left out
    float darkest;
    float brightest;
    float chroma_squared;
} push;

layout(constant_id = 0) const uint COMPONENTS = 3u;
layout(constant_id = 1) const uint ADAPTATION = 0u;
// Whether the picture is first brought to the background's light.
layout(constant_id = 2) const uint GAIN = 0u;

shared uint words[2];

uint byte_at(uint at) {
    return (colours[at >> 2u] >> (8u * (at & 3u))) & 255u;
}

float normal_density(float distance_squared, float variance) {
    precise float norm = 6.28318531 * variance;
    precise float halved = -0.5 * distance_squared;
    precise float volume = norm * square_root(norm);
    return quotient(exp_of_negative(quotient(halved, variance)), volume);
}

void start(uint at, uint pixels, vec3 seen, uint components) {
    for (uint k = 0u; k < components; k++) {
        bool is_seen = k == 0u;
        uint field = at + k * MIXTURE_FIELDS * pixels;
        state[field] = is_seen ? 1.0 : 0.0;
        // Out of every colour's reach.
        state[field + pixels] = is_seen ? seen.x : -1e4;
        state[field + 2u * pixels] = is_seen ? seen.y : -1e4;
        state[field + 3u * pixels] = is_seen ? seen.z : -1e4;
        state[field + 4u * pixels] = push.initial_variance;
    }
}

// Learns from a colour; whether it is foreground.
bool learn(uint at, uint pixels, vec3 seen, uint components, uint adaptation) {
    float weight[5];
    vec3 mean[5];
    float variance[5];
    float distance_squared[5];
    float rank[5];
    for (uint k = 0u; k < components; k++) {
        uint field = at + k * MIXTURE_FIELDS * pixels;
        weight[k] = state[field];
        mean[k] = vec3(state[field + pixels], state[field + 2u * pixels], state[field + 3u * pixels]);
        variance[k] = state[field + 4u * pixels];
        precise vec3 apart = seen - mean[k];
        distance_squared[k] = product(apart, apart);
        precise float squared = weight[k] * weight[k];
        rank[k] = quotient(squared, variance[k]);
    }
    uint best = components;
    float best_rank = -1.0;
    uint least = 0u;
    float least_rank = rank[0];
    vec3 top = vec3(0.0);
    float top_rank = -1.0;
    for (uint k = 0u; k < components; k++) {
        precise float reach = push.match_squared * variance[k];
        if (distance_squared[k] <= reach && rank[k] > best_rank) {
            best = k;
            best_rank = rank[k];
        }
        if (rank[k] < least_rank) {
            least = k;
            least_rank = rank[k];
        }
        if (rank[k] > top_rank) {
            top = mean[k];
            top_rank = rank[k];
        }
    }
    precise float before = 0.0;
    for (uint k = 0u; k < components; k++) {
        if (rank[k] > best_rank) before = before + weight[k];
    }
    bool found = best == components || before >= push.background_weight;
    if (found && push.suppress != 0u) found = !covers(seen, top, push.darkest, push.brightest, push.chroma_squared);

    float alpha = rates.alpha;
    precise float kept = 1.0 - alpha;
    precise float total = 0.0;
    for (uint k = 0u; k < components; k++) {
        bool matched = best == k;
        precise float new_weight = weight[k] * kept + (matched ? alpha : 0.0);
        float rho = 0.0;
        if (matched) {
            if (adaptation == ADAPTATION_DENSITY) {
                precise float share = alpha * normal_density(distance_squared[k], variance[k]);
                rho = min(share, 1.0);
            } else {
                rho = min(quotient(alpha, max(new_weight, 1e-6)), 1.0);
            }
        }
        precise vec3 moved = mean[k] + rho * (seen - mean[k]);
        precise float stays = 1.0 - rho;
        precise float left = stays * stays * distance_squared[k];
        precise float spread = variance[k] + rho * (left - variance[k]);
        bool replaced = best == components && least == k;
        mean[k] = replaced ? seen : moved;
        variance[k] = replaced ? push.initial_variance : max(spread, push.least_variance);
        weight[k] = replaced ? push.initial_weight : new_weight;
        total = total + weight[k];
    }
    for (uint k = 0u; k < components; k++) {
        uint field = at + k * MIXTURE_FIELDS * pixels;
        state[field] = quotient(weight[k], total);
        state[field + pixels] = mean[k].x;
        state[field + 2u * pixels] = mean[k].y;
        state[field + 3u * pixels] = mean[k].z;
        state[field + 4u * pixels] = variance[k];
    }
    return found;
}

void main() {
    uint lane = gl_LocalInvocationID.x;
    uint x = gl_GlobalInvocationID.x;
    uint row = gl_GlobalInvocationID.y;
    uint components = COMPONENTS;
    uint adaptation = ADAPTATION;
    uint fits_light = GAIN;
    if (lane < 2u) words[lane] = 0u;
    barrier();
    if (x < push.width) {
        uint at = row * push.width + x;
        uint pixels = push.rows * push.width;
        uint first_byte = 3u * (push.first_row * push.width + at);
        precise vec3 seen = vec3(float(byte_at(first_byte)), float(byte_at(first_byte + 1u)), float(byte_at(first_byte + 2u)));
        if (rates.first != 0u) {
            start(at, pixels, seen, components);
        } else {
            if (fits_light != 0u) {
                precise vec3 gain = vec3(float(gains[0]), float(gains[1]), float(gains[2])) * 0.0078125;
                seen = seen * vec3(quotient(1.0, gain.x), quotient(1.0, gain.y), quotient(1.0, gain.z));
            }
            if (learn(at, pixels, seen, components, adaptation)) atomicOr(words[lane >> 5u], 1u << (lane & 31u));
        }
    }
    barrier();
    if ((lane & 31u) == 0u) foreground[(push.first_row + row) * push.stride + (x >> 5u)] = words[lane >> 5u];
}
