#version 450
#extension GL_GOOGLE_include_directive : require

// The pictures of all views, people over the empty room: one ray through each quarter of a pixel against what may be seen in its
// tile. A workgroup's first number is the tile, its second the view. What comes out is linear light, and in w how many
// quarters of the pixel the first member covers.

#include "synth/ray.glsl"
#include "synth/clothes.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, set = 0, binding = 4) readonly buffer Views { View views[]; };
// As `bins`: where the candidates of each tile begin, then the candidates.
layout(std430, set = 0, binding = 5) readonly buffer Tiles { uint tiles[]; };
layout(std430, set = 0, binding = 7) readonly buffer Directions { float directions[]; };
// The empty room: light, and in w 1 on the floor.
layout(std430, set = 0, binding = 8) readonly buffer Plates { vec4 plates[]; };
// Where the middle of each pixel meets the floor, mm.
layout(std430, set = 0, binding = 9) readonly buffer Floors { vec2 floors[]; };
layout(std430, set = 0, binding = 10) readonly buffer Shades { vec2 shades[]; };
layout(std430, set = 0, binding = 11) writeonly buffer Pictures { vec4 pictures[]; };

// Distance off a surface from which its shadow is asked, mm.
const float LIFT = 2.0;
// The lamp's share of the light on the floor.
const float KEY_SHARE = 0.40;
// Surfaces closer than this are shaded as one, mm.
const float BLEND = 30.0;
// The bits of a candidate that are a primitive's number.
const uint PRIMITIVE = (1u << MEMBER_SHIFT) - 1u;

vec3 corner_direction(View view, uvec2 corner) {
    uint i = 3u * (view.first_corner + corner.y * (view.size.x + 1u) + corner.x);
    return vec3(directions[i], directions[i + 1u], directions[i + 2u]);
}

vec3 ray_direction(View view, uvec2 pixel, vec2 f) {
    vec3 upper = mix(corner_direction(view, pixel), corner_direction(view, pixel + uvec2(1u, 0u)), f.x);
    vec3 lower = mix(corner_direction(view, pixel + uvec2(0u, 1u)), corner_direction(view, pixel + 1u), f.x);
    return normalize(mix(upper, lower, f.y));
}

// The factor of all members' shadows at a point of the floor.
float floor_light(vec2 at) {
    float factor = 1.0;
    for (uint number = 0u; number < push.members; number++) {
        vec2 origin = members[number].floor_middle - 0.5 * SHADOW_CELL * float(SHADOW_SIDE);
        vec2 p = (at - origin) / SHADOW_CELL - 0.5;
        if (any(lessThan(p, vec2(0.0))) || any(greaterThanEqual(p, vec2(float(SHADOW_SIDE - 1u))))) continue;
        uvec2 cell = uvec2(p);
        vec2 f = p - vec2(cell);
        uint i = (number * SHADOW_SIDE + cell.y) * SHADOW_SIDE + cell.x;
        vec2 low = mix(shades[i], shades[i + 1u], f.x);
        vec2 high = mix(shades[i + SHADOW_SIDE], shades[i + SHADOW_SIDE + 1u], f.x);
        vec2 shade = mix(low, high, f.y);
        factor *= KEY_SHARE * shade.x + (1.0 - KEY_SHARE) * shade.y;
    }
    return factor;
}

bool joins(uint a, uint b) {
    return a == b || (max(a, b) == LOOK_FACE && min(a, b) == LOOK_SKIN);
}

// The normal mixed with those of solids of the same look that pass close by.
vec3 blended(vec3 normal, vec3 point, uint member, uint look, uvec2 candidates) {
    vec3 sum = normal * 1e-3;
    for (uint i = candidates.x; i < candidates.y; i++) {
        if (tiles[i] >> MEMBER_SHIFT != member) continue;
        uint solid = tiles[i] & PRIMITIVE;
        if (!joins(solids[solid].look, look)) continue;
        vec3 own;
        float weight = max(1.0 - abs(solid_near(solid, point, own)) / BLEND, 0.0);
        sum += own * (weight * weight);
    }
    return dot(sum, sum) > 0.0 ? unit(sum) : normal;
}

// The light from where a ray first meets someone (`member`), or nothing.
bool first_light(vec3 origin, vec3 direction, uvec2 candidates, out uint member, out vec3 light) {
    float nearest = MISS;
    uint nearest_candidate = 0u;
    for (uint i = candidates.x; i < candidates.y; i++) {
        bool is_mesh = members[tiles[i] >> MEMBER_SHIFT].is_mesh != 0u;
        float t = first_hit(is_mesh, tiles[i] & PRIMITIVE, origin, direction);
        if (t > 0.0 && (nearest < 0.0 || t < nearest)) {
            nearest = t;
            nearest_candidate = tiles[i];
        }
    }
    light = vec3(0.0);
    member = nearest_candidate >> MEMBER_SHIFT;
    if (nearest < 0.0) return false;
    uint i = nearest_candidate & PRIMITIVE;
    vec3 point = origin + direction * nearest;
    vec3 facet;
    vec3 normal;
    uint look;
    vec3 at;
    vec3 colour = vec3(-1.0);
    if (members[member].is_mesh != 0u) {
        look = triangles[i].look;
        vec3 e = triangles[i].edges[0].xyz;
        vec3 f = triangles[i].edges[1].xyz;
        vec3 plane = cross(e, f);
        vec3 from = point - triangles[i].corner.xyz;
        float area = max(dot(plane, plane), 1e-12);
        float u = dot(cross(from, f), plane) / area;
        float v = dot(cross(e, from), plane) / area;
        vec3 shares = vec3(1.0 - u - v, u, v);
        at = triangles[i].rest[0].xyz * shares.x + triangles[i].rest[1].xyz * shares.y + triangles[i].rest[2].xyz * shares.z;
        vec3 mixed = triangles[i].normals[0].xyz * shares.x + triangles[i].normals[1].xyz * shares.y
            + triangles[i].normals[2].xyz * shares.z;
        facet = dot(mixed, mixed) > 0.0 ? unit(mixed) : plane;
        normal = facet;
        colour = worn_colour(look, triangles[i].finish, at);
    } else {
        look = solids[i].look;
        vec4 h = vec4(point, 1.0);
        at = vec3(dot(solids[i].object[0], h), dot(solids[i].object[1], h), dot(solids[i].object[2], h));
        if (look == LOOK_FACE) colour = painted_face(solids[i].is_jaw != 0u, solid_local(i, point - solids[i].centre.xyz));
        if (colour.r < 0.0) colour = worn_colour(look, solids[i].finish, at);
        solid_near(i, point, facet);
        normal = blended(facet, point, member, look, candidates);
    }
    vec3 lifted = point + facet * LIFT;
    normal = unit(normal + folds(look, at));
    float key = max(dot(normal, members[member].to_light.xyz), 0.0);
    for (uint other = 0u; other < push.members && key > 0.0; other++) {
        if (in_shadow(other, lifted)) key = 0.0;
    }
    float up = 0.5 + 0.5 * normal.z;
    float open = 0.72 + 0.28 * clamp(point.z / 500.0, 0.0, 1.0);
    vec3 arriving = vec3(0.98, 0.94, 0.86) * key + vec3(0.44, 0.46, 0.50) * (up * open)
        + vec3(0.25, 0.22, 0.18) * ((1.0 - up) * open);
    float grazing = clamp(1.0 + dot(normal, direction), 0.0, 1.0);
    light = colour * arriving + vec3(0.024 * grazing * grazing * grazing);
    return true;
}

void main() {
    View view = views[gl_WorkGroupID.y];
    uint tile = gl_WorkGroupID.x;
    if (view.is_wanted == 0u || tile >= view.tiles) return;
    uvec2 pixel = uvec2(tile % view.columns, tile / view.columns) * TILE_SIDE + gl_LocalInvocationID.xy;
    if (any(greaterThanEqual(pixel, view.size))) return;
    uint i = view.first_pixel + pixel.y * view.size.x + pixel.x;
    vec4 plate = plates[i];
    vec3 behind = plate.rgb;
    if (plate.w > 0.0) behind *= floor_light(floors[i]);
    uvec2 candidates = uvec2(tiles[view.first_tile + tile], tiles[view.first_tile + tile + 1u]);
    vec3 sum = vec3(0.0);
    float count = 0.0;
    float first = 0.0;
    if (candidates.x < candidates.y) {
        for (uint quarter = 0u; quarter < 4u; quarter++) {
            vec2 f = vec2(quarter & 1u, quarter >> 1u) * 0.5 + 0.25;
            uint member;
            vec3 light;
            if (first_light(view.centre, ray_direction(view, pixel, f), candidates, member, light)) {
                sum += light;
                count += 1.0;
                first += member == 0u ? 1.0 : 0.0;
            }
        }
    }
    pictures[i] = vec4(behind * (1.0 - count / 4.0) + sum / 4.0, first);
}
