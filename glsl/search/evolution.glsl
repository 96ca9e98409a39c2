// What an evolution keeps between its stages: distributions work in units of the frame's spread about its centre.

// A stage reads so many numbers before it adds the first, so that a card waits for memory once for all of them.
const uint READ_AT_ONCE = 8u;

layout(std430, set = SEARCH_SET, binding = 2) buffer Evolution {
    float sigma;    // step size
    uint first;     // best sample of the generation
    float values[]; // rows of the mean, the path of the step size, and the lower and upper limits
} evolution;

// The frame's centre, within the limits.
float centre_of(uint d, uint dofs) {
    return hold(frame.values[d], frame.values[2u * dofs + d], frame.values[3u * dofs + d]);
}

// The pose's value at `offset` spreads off the centre.
float pose_at(float offset, uint d, uint dofs) {
    precise float x = centre_of(d, dofs) + frame.values[dofs + d] * offset;
    return hold(x, frame.values[2u * dofs + d], frame.values[3u * dofs + d]);
}

float held_offset(float offset, uint d, uint dofs) {
    return hold(offset, evolution.values[2u * dofs + d], evolution.values[3u * dofs + d]);
}
