#version 450
#extension GL_GOOGLE_include_directive : require

// A generation's samples: normal numbers turned by the matrix. One workgroup a sample, one invocation a row of the matrix at a time.

#include "search/constants.glsl"
#include "search/frame.glsl"
#include "search/evolution.glsl"

layout(local_size_x = SEARCH_GROUP) in;

layout(std430, set = 0, binding = 3) readonly buffer Matrix { float matrix[]; };
// Rows a sample: its normal numbers, and its steps off the mean over the step size.
layout(std430, set = 0, binding = 4) writeonly buffer Normals { float normals[]; };
layout(std430, set = 0, binding = 5) writeonly buffer Steps { float steps[]; };
layout(std430, set = 0, binding = 6) writeonly buffer Positions { float positions[]; };

layout(push_constant) uniform Push {
    uint samples;
    uint dofs;
    uint iteration;
    uint first; // particle of the generation
} push;

// Normal numbers of SEARCH_GROUP dimensions: two groups of eight blocks.
shared float numbers[SEARCH_GROUP];

// Fills `numbers` from dimension `from` on.
void draw(uint particle, uint from) {
    uint lane = gl_LocalInvocationID.x;
    barrier();
    if (lane < SEARCH_GROUP / 4u) {
        uint block = from / 4u + lane;
        vec4 drawn = normals_of(random_words(push.iteration, particle, DRAW_SCATTER, block));
        // The first sample of a frame is its centre.
        bool is_centre = push.iteration == 0u && particle == 0u;
        for (uint word = 0u; word < 4u; word++) {
            numbers[dimension_of(block, word) - from] = is_centre ? 0.0 : drawn[word];
        }
    }
    barrier();
}

void main() {
    uint sample_index = gl_WorkGroupID.z * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint lane = gl_LocalInvocationID.x;
    // All of a workgroup leave together.
    if (sample_index >= push.samples) return;
    float sigma = evolution.sigma;
    float inverse = reciprocal(sigma);
    for (uint base = 0u; base < push.dofs; base += SEARCH_GROUP) {
        uint row = base + lane;
        precise float step = 0.0;
        float own = 0.0;
        for (uint from = 0u; from < push.dofs; from += SEARCH_GROUP) {
            draw(push.first + sample_index, from);
            uint count = min(SEARCH_GROUP, push.dofs - from);
            if (from == base) own = numbers[lane];
            if (row < push.dofs) {
                for (uint column = 0u; column < count; column++) {
                    precise float part = matrix[(from + column) * push.dofs + row] * numbers[column];
                    step = step + part;
                }
            }
        }
        if (row < push.dofs) {
            float mean = evolution.values[row];
            precise float free = mean + sigma * step;
            float held = held_offset(free, row, push.dofs);
            precise float kept = (held - mean) * inverse;
            uint place = sample_index * push.dofs + row;
            normals[place] = own;
            steps[place] = held == free ? step : kept;
            positions[place] = pose_at(held, row, push.dofs);
        }
    }
}
