#version 450
#extension GL_GOOGLE_include_directive : require

// What is likelier to be of any colour than background, smoothed by 1 2 1 both ways: 32 pixels of a row an invocation.

#include "features/constants.glsl"
#include "features/picture.glsl"
#include "features/place.glsl"

layout(local_size_x = 64) in;

// The log density of each pixel as background in the lower half, steps.
layout(std430, set = 0, binding = 0) readonly buffer Seen { uint seen[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Foreground { uint foreground[]; };

// Pixels at the border count for those beyond.
int ratio(uint x, uint y) {
    int density = int(seen[y * picture.width + x] << 16u) >> 16;
    return clamp(-density, -int(LIKELIHOOD_MOST), int(LIKELIHOOD_MOST));
}

int column(int x, uint y) {
    uint inside = uint(clamp(x, 0, int(picture.width) - 1));
    return ratio(inside, max(y, 1u) - 1u) + 2 * ratio(inside, y) + ratio(inside, min(y + 1u, picture.height - 1u));
}

void main() {
    uint place = flat_place();
    if (place >= picture.stride * picture.height) return;
    uint y = place / picture.stride;
    uint first = place % picture.stride * 32u;
    uint bits = 0u;
    if (first < picture.width) {
        uint count = min(32u, picture.width - first);
        int before = column(int(first) - 1, y);
        int here = column(int(first), y);
        for (uint i = 0u; i < count; i++) {
            int after = column(int(first + i) + 1, y);
            if (before + 2 * here + after > 16 * int(LIKELIHOOD_FOREGROUND)) bits |= 1u << i;
            before = here;
            here = after;
        }
    }
    foreground[place] = bits;
}
