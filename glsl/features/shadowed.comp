#version 450
#extension GL_GOOGLE_include_directive : require

// Counts what looks like background round what was found, and what of it is in shadow: every so many rows and columns.

#include "features/likely.glsl"
#include "features/place.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 6) buffer Counted { uint counted[]; };

shared uint here[2];

const uint EVERY = RATIO_GRID / 2u;

void main() {
    uint lane = gl_LocalInvocationID.x;
    if (lane < 2u) here[lane] = 0u;
    barrier();
    uint columns = (push.width + EVERY - 1u) / EVERY;
    uint place = flat_place();
    uvec4 near = region();
    uvec2 at = near.xy + EVERY * uvec2(place % columns, place / columns);
    if (all(lessThan(at, near.zw))) {
        uint pixel = at.y * push.width + at.x;
        vec2 found = hypotheses(colour_of(pixel), pixel, light.counting[slope_of(pixel)]);
        if (max(found.x, found.y) > 0.0) {
            if (found.y > found.x) atomicAdd(here[0], 1u);
            atomicAdd(here[1], 1u);
        }
    }
    barrier();
    if (lane < 2u && here[lane] != 0u) atomicAdd(counted[lane], here[lane]);
}
