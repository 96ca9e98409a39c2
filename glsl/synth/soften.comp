#version 450
#extension GL_GOOGLE_include_directive : require

// The factors of light on the floor: the lamp's (x) softened, as by a lamp of some width, and that from all around (y).

#include "synth/constants.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, set = 0, binding = 0) readonly buffer Hidden { vec2 hidden[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Shades { vec2 shades[]; };

// Three boxes of 3 after each other, of 27.
const float BELL[7] = float[](1.0, 3.0, 6.0, 7.0, 6.0, 3.0, 1.0);

void main() {
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    int side = int(SHADOW_SIDE);
    if (any(greaterThanEqual(cell, ivec2(side)))) return;
    int first = int(gl_WorkGroupID.z) * side * side;
    float key = 0.0;
    for (int dy = -3; dy <= 3; dy++) {
        float row = 0.0;
        for (int dx = -3; dx <= 3; dx++) {
            ivec2 at = clamp(cell + ivec2(dx, dy), ivec2(0), ivec2(side - 1));
            row += BELL[dx + 3] / 27.0 * hidden[first + at.y * side + at.x].x;
        }
        key += BELL[dy + 3] / 27.0 * row;
    }
    // The grid ends softly, so that its border cannot be seen.
    vec2 away = abs((vec2(cell) + 0.5) / (0.5 * float(side)) - 1.0);
    float fade = clamp((1.0 - max(away.x, away.y)) * 6.0, 0.0, 1.0);
    int i = first + cell.y * side + cell.x;
    shades[i] = vec2(1.0 - (1.0 - key) * fade, 1.0 - min(hidden[i].y * fade, 0.75));
}
