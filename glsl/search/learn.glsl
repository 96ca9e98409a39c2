// What a generation teaches, in one stage behind its drawing: fitness, the samples' weights by their ranks, mean, path, step size, the best
// sample so far, and the next matrix. Each workgroup finds all but the matrix by itself, the first one writes it down, and each makes a
// share of the matrix; so none waits for another, which Vulkan lets none, and the state goes from one memory to another.

#define SEARCH_SET 1
#include "search/constants.glsl"
#include "search/frame.glsl"
#include "search/outcome.glsl"
#include "search/evolution.glsl"
#include "evaluate/scoring.glsl"

layout(local_size_x = SUM_LANES) in;

// As `evolution`, for the next generation.
layout(std430, set = 1, binding = 3) writeonly buffer NextEvolution {
    float sigma;
    uint first;
    float values[];
} next_evolution;
layout(std430, set = 1, binding = 8) writeonly buffer Next { float next[]; };
layout(std430, set = 1, binding = 9) readonly buffer Positions { float positions[]; };
// What stands behind the fitness of the best sample, a row of views.
layout(std430, set = 1, binding = 10) writeonly buffer BestSums { uvec4 best_sums[]; };

layout(push_constant) uniform Learn {
    Scoring scoring;
    uint dofs;
    uint first_weight;
    uint parents;
    float path_kept;
    float path_gain;
    float sigma_gain;
    float sigma_loss;
    float kept;
    float of_path;
    float of_samples;
} push;

shared uint keys[LEARN_SAMPLES];
shared float weights[LEARN_SAMPLES];
shared float path[LEARN_DOFS];
shared uint first;
shared uint before;

#define KEY(sample_index) keys[sample_index]
#define PATH(d) path[d]
#include "search/scored.glsl"
#include "search/ranking.glsl"
#include "search/learning.glsl"
#include "search/turning.glsl"

void main() {
    uint lane = gl_LocalInvocationID.x;
    bool writes = gl_WorkGroupID.x == 0u;
    uint samples = push.scoring.candidates;
    uint dofs = push.dofs;
    for (uint own = lane; own < samples; own += SUM_LANES) keys[own] = total_order_of(fitness_of(own));
    if (writes && lane == 0u) before = outcome.key;
    barrier();
    for (uint own = lane; own < samples; own += SUM_LANES) {
        uint rank = rank_of(own, samples);
        if (rank == 0u) first = own;
        weights[own] = weight_of(own, rank);
    }
    barrier();
    uint now = with_one_zero(keys[first]);
    if (writes && now > before) {
        if (lane == 0u) outcome.key = now;
        for (uint d = lane; d < dofs; d += SUM_LANES) outcome.values[d] = positions[first * dofs + d];
        for (uint view = lane; view < push.scoring.views; view += SUM_LANES) {
            best_sums[view] = sums_at(first * push.scoring.views + view);
        }
    }
    float sigma = evolution.sigma;
    precise float square = 0.0;
    for (uint d = lane; d < dofs; d += SUM_LANES) {
        // A generation without any finite fitness teaches nothing.
        vec2 learnt = weighed(d, samples);
        float own = now == 0u ? evolution.values[dofs + d] : path_after(d, learnt.x);
        path[d] = own;
        precise float squared = own * own;
        square = square + squared;
        if (writes) {
            next_evolution.values[d] = now == 0u ? evolution.values[d] : mean_after(d, learnt.y, sigma);
            next_evolution.values[dofs + d] = own;
            next_evolution.values[2u * dofs + d] = evolution.values[2u * dofs + d];
            next_evolution.values[3u * dofs + d] = evolution.values[3u * dofs + d];
        }
    }
    float all = sum_of_squares(square);
    if (writes && lane == 0u) next_evolution.sigma = now == 0u ? sigma : sigma_after(sigma, all);
    uint share = (dofs * dofs + gl_NumWorkGroups.x - 1u) / gl_NumWorkGroups.x;
    uint begin = gl_WorkGroupID.x * share;
    uint end = min(begin + share, dofs * dofs);
    for (uint place = begin + lane; place < end; place += SUM_LANES) {
        next[place] = now == 0u ? matrix[place] : entry_after(place % dofs, place / dofs, samples);
    }
}
