// A particle's move in one dimension (METHOD A8). Whoever includes it has push constants `push` with inertia, cognitive and social.

struct Step {
    float position;
    float velocity;
};

// From a position with this velocity, drawn to the particle's best and to that of all by `r`, within limits.
Step step_from(float x, float velocity, vec2 best, vec2 r, vec2 limits) {
    precise float kept = push.inertia * velocity;
    precise float to_own = push.cognitive * r.x * (best.x - x);
    precise float to_best = push.social * r.y * (best.y - x);
    precise float faster = kept + to_own + to_best;
    precise float free = x + faster;
    float held = hold(free, limits.x, limits.y);
    return Step(held, held == free ? faster : 0.0);
}
