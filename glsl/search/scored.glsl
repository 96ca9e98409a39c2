// The fitness of a candidate, for stages that go on with it, and the sums behind it: made here from the sums of SILHOUETTES, SEGMENTED or
// EVIDENCE, or read where a stage before has made it. Whoever includes it has declared `push` with a Scoring called `scoring`.

#if defined(SILHOUETTES) || defined(SEGMENTED) || defined(EVIDENCE)
#include "evaluate/fitness.glsl"
#else
#include "evaluate/model.glsl"

layout(std430, set = 0, binding = 1) readonly buffer AllSums { Sums sums[]; };
layout(std430, set = 0, binding = 2) readonly buffer Fitness { float fitness[]; };

float fitness_of(uint candidate) {
    return fitness[candidate];
}
#endif

uvec4 sums_at(uint place) {
    return uvec4(sums[place].area_model, sums[place].overlap, sums[place].edges, sums[place].proximity);
}
