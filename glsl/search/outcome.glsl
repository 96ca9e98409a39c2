// What a search has found.

layout(std430, set = SEARCH_SET, binding = 1) buffer Outcome {
    uint key;       // order of the best fitness, 0 while none was finite
    uint stride;    // of the pointers of systematic resampling
    float values[]; // rows of the best pose, the deviation and the mean
} outcome;
