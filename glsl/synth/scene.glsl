// People in one instant, as synth's stages read them, and the views of them.

#ifndef SYNTH_SCENE
#define SYNTH_SCENE

#include "synth/constants.glsl"
#include "texture/materials.glsl"

// An ellipsoid or a capsule.
struct Solid {
    vec4 local[3];  // rows of local_from_world about `centre`; w: length, first and second radius of a capsule
    vec4 object[3]; // rows of object_from_world, what it is made of lies in the object's frame
    vec4 centre;    // world, mm; w: how far the solid reaches from there
    uint is_capsule;
    uint look;      // LOOK_*
    uint finish;    // 0 for the tailor's own, else one more than the number of a finish
    uint is_jaw;    // of a face: it carries the mouth alone
};

struct Triangle {
    vec4 corner;     // world, mm
    vec4 edges[2];   // to the two other corners
    vec4 normals[3];
    vec4 rest[3];    // corners on the person at rest, mm
    uint look;
    uint finish;
    uint pad0;
    uint pad1;
};

// A person and the light as it falls on him.
struct Member {
    vec4 to_light;
    vec4 across[2];    // span the plane across the light
    vec2 bins_origin;  // in that plane, mm
    uvec2 bins_size;
    float bin_width;   // mm
    uint first_bin;    // in `bins`
    uint is_mesh;
    uint first_pair;   // in `balls`: what stands for him where light comes from all around
    uint pairs;
    uint pad0;
    vec2 floor_middle; // of his shadow, mm
};

struct View {
    vec3 centre;      // of projection, world, mm
    uint is_wanted;
    uvec2 size;       // pixels
    uint first_pixel;
    uint first_corner; // in `directions`, (width + 1) x (height + 1) corners of pixels
    uint first_tile;
    uint columns;     // of tiles
    uint tiles;
    uint pad0;
};

struct Finish {
    vec4 tint; // w: mm to a unit of the material
    Material material;
};

layout(std430, set = 0, binding = 0) readonly buffer Members { Member members[]; };
layout(std430, set = 0, binding = 1) readonly buffer Solids { Solid solids[]; };
layout(std430, set = 0, binding = 2) readonly buffer Triangles { Triangle triangles[]; };
// Where the list of each bin begins (and that of the next, where it ends), then the lists: numbers of primitives.
layout(std430, set = 0, binding = 3) readonly buffer Bins { uint bins[]; };

layout(push_constant) uniform Push {
    uint members;
} push;

#endif
