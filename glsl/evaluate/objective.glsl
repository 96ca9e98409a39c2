// The components of all views of a candidate to its fitness (METHOD A7): one invocation a candidate.

#include "evaluate/constants.glsl"
#include "evaluate/scoring.glsl"

layout(local_size_x = OBJECTIVE_GROUP) in;

layout(push_constant) uniform Objective {
    Scoring scoring;
} push;

#include "evaluate/fitness.glsl"

layout(std430, set = 0, binding = 2) writeonly buffer Fitness { float fitness[]; };

void main() {
    uint candidate = gl_GlobalInvocationID.x;
    if (candidate >= push.scoring.candidates) return;
    fitness[candidate] = fitness_of(candidate);
}
