#version 450
#extension GL_GOOGLE_include_directive : require

// The components of all views of a candidate to its fitness (SPEC A7): one invocation a candidate.

#include "evaluate/constants.glsl"
#include "evaluate/model.glsl"

layout(local_size_x = OBJECTIVE_GROUP) in;

layout(std430, set = 0, binding = 0) readonly buffer Cameras { Camera cameras[]; };
layout(std430, set = 0, binding = 1) readonly buffer AllSums { Sums sums[]; };
layout(std430, set = 0, binding = 2) writeonly buffer Fitness { float fitness[]; };

layout(push_constant) uniform Push {
    uint candidates;
    uint views;
    uint kind; // OBJECTIVE_*
    float beta;
    float w1;
    float w2;
} push;

// Sums of one or more views, in floating point: exact to 2^24 pixels, and never past its end.
struct Terms {
    float area_obs;
    float area_model;
    float overlap;
    float edges;
    float proximity;
};

float ratio(float numerator, float denominator) {
    return denominator > 0.0 ? numerator / denominator : 0.0;
}

// The base is 0 or more; what GLSL leaves undefined at 0 is what the processor computes there.
float power(float base, float exponent) {
    if (exponent == 0.5) return sqrt(base);
    if (base <= 0.0) return exponent == 0.0 ? 1.0 : 0.0;
    return pow(base, exponent);
}

float silhouette(Terms t) {
    return push.beta * ratio(t.overlap, t.area_obs) + (1.0 - push.beta) * ratio(t.overlap, t.area_model);
}

float edge(Terms t) {
    return ratio(t.proximity, 127.0 * t.edges);
}

bool is_nothing(Terms t) {
    return t.area_obs == 0.0 || t.area_model == 0.0;
}

float weighted_sum(Terms t) {
    return is_nothing(t) ? 0.0 : push.w1 * silhouette(t) + push.w2 * edge(t);
}

float product(Terms t) {
    return is_nothing(t) ? 0.0 : power(silhouette(t), push.w1) * power(edge(t), push.w2);
}

void main() {
    uint candidate = gl_GlobalInvocationID.x;
    if (candidate >= push.candidates) return;
    Terms all = Terms(0.0, 0.0, 0.0, 0.0, 0.0);
    float sum = 0.0;
    float products = 1.0;
    for (uint view = 0u; view < push.views; view++) {
        Sums seen = sums[candidate * push.views + view];
        Terms own = Terms(float(cameras[view].area_obs), float(seen.area_model), float(seen.overlap), float(seen.edges),
            float(seen.proximity));
        all.area_obs += own.area_obs;
        all.area_model += own.area_model;
        all.overlap += own.overlap;
        all.edges += own.edges;
        all.proximity += own.proximity;
        float value = push.kind == OBJECTIVE_AOWS ? weighted_sum(own) : product(own);
        sum += value;
        products *= value;
    }
    float value;
    if (push.kind == OBJECTIVE_WS) value = weighted_sum(all);
    else if (push.kind == OBJECTIVE_SP) value = product(all);
    else if (push.kind == OBJECTIVE_POSP) value = products;
    else value = sum / float(push.views);
    fitness[candidate] = value;
}
