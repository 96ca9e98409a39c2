// What a stage that makes fitness is told: how the terms become one number, and over which views.

const uint TERMS_SUM = 0u;
const uint OVER_TOGETHER = 0u;
const uint OVER_MEAN = 1u;
const uint OVER_PRODUCT = 2u;

// The numbers are those of Terms and Views in src/evaluate/objective.rs.
struct Scoring {
    uint candidates;
    uint views;
    uint terms; // TERMS_*
    uint over; // OVER_*
    float beta;
    float w1;
    float w2;
};
