// How many samples of a generation are better, of equals those drawn before, and the weight that makes. Whoever includes it has `push` with
// first_weight and parents, and says what KEY(sample) is: the total order of its fitness.

// Of the better half, best first.
layout(std430, set = SEARCH_SET, binding = 4) readonly buffer Ranked { float ranked[]; };

uint rank_of(uint own, uint samples) {
    uint key = KEY(own);
    uint rank = 0u;
    for (uint other = 0u; other < samples; other++) {
        uint found = KEY(other);
        if (found > key || (found == key && other < own)) rank++;
    }
    return rank;
}

float weight_of(uint own, uint rank) {
    return KEY(own) != 0u && rank < push.parents ? ranked[push.first_weight + rank] : 0.0;
}
