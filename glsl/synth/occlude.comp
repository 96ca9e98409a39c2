#version 450
#extension GL_GOOGLE_include_directive : require

// What each member takes from the light on the floor round him: x 1 where the lamp is seen and 0 where not, y the share of the
// sky that he hides. A workgroup's third number is the member.

#include "synth/ray.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// Pairs of balls whose hulls stand for the members, centre and radius.
layout(std430, set = 0, binding = 4) readonly buffer Balls { vec4 balls[]; };
layout(std430, set = 0, binding = 5) writeonly buffer Hidden { vec2 hidden[]; };

// The fraction of the sky that a ball hides, weighted by the sine of its height.
float hidden_by(vec4 ball, vec3 point) {
    vec3 offset = ball.xyz - point;
    float range = max(length(offset), ball.w);
    return ball.w * ball.w / (range * range) * max(offset.z / range, 0.0);
}

void main() {
    uvec2 cell = gl_GlobalInvocationID.xy;
    uint number = gl_WorkGroupID.z;
    if (any(greaterThanEqual(cell, uvec2(SHADOW_SIDE))) || number >= push.members) return;
    Member member = members[number];
    vec2 place = member.floor_middle + (vec2(cell) + 0.5 - 0.5 * float(SHADOW_SIDE)) * SHADOW_CELL;
    vec3 point = vec3(place, 0.0);
    float sky = 0.0;
    for (uint i = 0u; i < member.pairs; i++) {
        vec4 first = balls[2u * (member.first_pair + i)];
        vec4 second = balls[2u * (member.first_pair + i) + 1u];
        sky += 0.3 * hidden_by(first, point);
        if (first != second) sky += 0.3 * hidden_by(second, point);
    }
    hidden[(number * SHADOW_SIDE + cell.y) * SHADOW_SIDE + cell.x] = vec2(in_shadow(number, point) ? 0.0 : 1.0, sky);
}
