// The components of all views of a candidate to its fitness (METHOD A7), as a function. Whoever includes it has declared push constants
// `push` with a Scoring called `scoring`, and leaves it the bindings 0, 1, 3 and 4 of set 0.

#include "evaluate/constants.glsl"
#include "evaluate/model.glsl"
#include "arithmetic/elementary.glsl"
#include "arithmetic/rounding.glsl"

layout(std430, set = 0, binding = 0) readonly buffer Cameras { Camera cameras[]; };
layout(std430, set = 0, binding = 1) readonly buffer AllSums { Sums sums[]; };

#ifdef SEGMENTED
// Whether the edge term is that of the segments, weighed, too.
layout(constant_id = 0) const bool SEGMENT_EDGES = false;

layout(std430, set = 0, binding = 3) readonly buffer SegmentTable {
    float weights[MOST_SEGMENTS]; // 0 for those that are not
    uint numbers[LABELS];
    uint areas[];
} table;
layout(std430, set = 0, binding = 4) readonly buffer AllSegmentSums { Sums segment_sums[]; };
#endif

#ifdef EVIDENCE
layout(std430, set = 0, binding = 3) readonly buffer EvidenceTable {
    uint classes[LABELS];
    uint count;
    uint best[]; // [view]
} table;
layout(std430, set = 0, binding = 4) readonly buffer AllEvidence { int evidence[]; };

// What the term of evidence never falls below.
const float LEAST_EVIDENCE = 1e-6;
#endif

// Sums of one or more views, in floating point: exact to 2^24 pixels, and never past its end.
struct Terms {
    float area_obs;
    float area_model;
    float overlap;
    float edges;
    float proximity;
};

float ratio(float numerator, float denominator) {
    return denominator > 0.0 ? quotient(numerator, denominator) : 0.0;
}

// The base is from 0 to 1, the exponent over 0. Exponents in eighths are products of square roots, in the order of the processor.
float power(float base, float exponent) {
    float eighths = 8.0 * exponent;
    if (eighths == floor(eighths) && eighths >= 1.0 && eighths <= 8.0) {
        uint bits = uint(eighths);
        float half_power = square_root(base);
        float quarter = square_root(half_power);
        precise float product = 1.0;
        if ((bits & 8u) != 0u) product *= base;
        if ((bits & 4u) != 0u) product *= half_power;
        if ((bits & 2u) != 0u) product *= quarter;
        if ((bits & 1u) != 0u) product *= square_root(quarter);
        return product;
    }
    if (base <= 0.0) return 0.0;
    return real_power(base, exponent);
}

float silhouette(float overlap, float area_obs, float area_model) {
    precise float covered = push.scoring.beta * ratio(overlap, area_obs);
    precise float sum = covered + (1.0 - push.scoring.beta) * ratio(overlap, area_model);
    return sum;
}

bool is_nothing(Terms t) {
    return t.area_obs == 0.0 || t.area_model == 0.0;
}

// The first term of some views of a candidate; negative where they score 0.
float views_area(Terms t, uint candidate, uint first_view, uint end_view) {
#ifdef EVIDENCE
    // The sums of all views fit 32 bits, the library sees to it.
    int sum = 0;
    uint best = 0u;
    for (uint view = first_view; view < end_view; view++) {
        sum += evidence[candidate * push.scoring.views + view];
        best += table.best[view];
    }
    if (t.area_model == 0.0 || best == 0u) return -1.0;
    return max(ratio(float(max(sum, 0)), float(best)), LEAST_EVIDENCE);
#else
    if (is_nothing(t)) return -1.0;
#ifdef SEGMENTED
    precise float term = 0.0;
    for (uint segment = 0u; segment < MOST_SEGMENTS; segment++) {
        float area_obs = 0.0;
        float area_model = 0.0;
        float overlap = 0.0;
        for (uint view = first_view; view < end_view; view++) {
            Sums seen = segment_sums[(candidate * push.scoring.views + view) * MOST_SEGMENTS + segment];
            area_obs += float(table.areas[view * MOST_SEGMENTS + segment]);
            area_model += float(seen.area_model);
            overlap += float(seen.overlap);
        }
        term += table.weights[segment] * silhouette(overlap, area_obs, area_model);
    }
    return term;
#else
    return silhouette(t.overlap, t.area_obs, t.area_model);
#endif
#endif
}

float edge(float edges, float proximity) {
    precise float most = 127.0 * edges;
    return ratio(proximity, most);
}

// The second term of some views of a candidate.
float views_edge(Terms t, uint candidate, uint first_view, uint end_view) {
#ifdef SEGMENTED
    if (SEGMENT_EDGES) {
        precise float term = 0.0;
        for (uint segment = 0u; segment < MOST_SEGMENTS; segment++) {
            float edges = 0.0;
            float proximity = 0.0;
            for (uint view = first_view; view < end_view; view++) {
                Sums seen = segment_sums[(candidate * push.scoring.views + view) * MOST_SEGMENTS + segment];
                edges += float(seen.edges);
                proximity += float(seen.proximity);
            }
            term += table.weights[segment] * edge(edges, proximity);
        }
        return term;
    }
#endif
    return edge(t.edges, t.proximity);
}

float score(Terms t, uint candidate, uint first_view, uint end_view) {
    float f1 = views_area(t, candidate, first_view, end_view);
    if (f1 < 0.0) return 0.0;
    float f2 = views_edge(t, candidate, first_view, end_view);
    precise float together;
    if (push.scoring.terms == TERMS_SUM) together = push.scoring.w1 * f1 + push.scoring.w2 * f2;
    else together = power(f1, push.scoring.w1) * power(f2, push.scoring.w2);
    return together;
}

float fitness_of(uint candidate) {
    // One score of all views, or one of each.
    Terms all = Terms(0.0, 0.0, 0.0, 0.0, 0.0);
    precise float sum = 0.0;
    precise float products = 1.0;
    for (uint view = 0u; view < push.scoring.views; view++) {
        Sums seen = sums[candidate * push.scoring.views + view];
        Terms own = Terms(float(cameras[view].area_obs), float(seen.area_model), float(seen.overlap), float(seen.edges),
            float(seen.proximity));
        if (push.scoring.over == OVER_TOGETHER) {
            all.area_obs += own.area_obs;
            all.area_model += own.area_model;
            all.overlap += own.overlap;
            all.edges += own.edges;
            all.proximity += own.proximity;
        } else {
            float value = score(own, candidate, view, view + 1u);
            sum += value;
            products *= value;
        }
    }
    if (push.scoring.over == OVER_TOGETHER) return score(all, candidate, 0u, push.scoring.views);
    if (push.scoring.over == OVER_MEAN) return quotient(sum, float(push.scoring.views));
    return push.scoring.over == OVER_PRODUCT ? products : 0.0;
}
