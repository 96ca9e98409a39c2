// The picture that a pass works on.

#ifndef FEATURES_PICTURE
#define FEATURES_PICTURE

layout(push_constant) uniform Picture {
    uint width;  // pixels
    uint height; // pixels
    uint stride; // 32-bit words of a row of a bit picture
    uint limit;  // the distance from which on all pixels are alike
    int amount;  // of the edges: the threshold
    int low;     // of Canny's edges: the lower threshold
} picture;

#endif
