#version 450
#extension GL_GOOGLE_include_directive : require

// A sum of octaves at the point of each pixel: `points` has one a pixel, row by row.

#include "texture/octaves.glsl"

layout(push_constant) uniform Push {
    uint width;
    uint octaves;
} push;

layout(location = 0) out float value;

void main() {
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    uint word;
    value = octave_sum(points[pixel.y * push.width + pixel.x], push.octaves, word);
}
