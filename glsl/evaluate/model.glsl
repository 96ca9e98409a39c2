// What a frame's candidates share: the body, the cameras, and how many of everything there are (METHOD A2-A4).

#ifndef EVALUATE_MODEL
#define EVALUATE_MODEL

// A bone; every parent stands before its children.
struct Bone {
    vec3 offset;   // origin in the parent's frame, mm
    float parity;  // +1 for a cyclic order of Euler axes, -1 for the others
    int parent;    // -1 for a root
    uint axes;     // Euler axes, leftmost first, two bits each
    int slots[6];  // where in the pose tx ty tz rx ry rz stand, -1 for none
};

// A truncated cone of the flat model.
struct Part {
    vec3 a;         // one end in the bone's frame, mm
    float radius_a; // mm
    vec3 b;         // the other end
    float radius_b;
    uint bone;
    uint label; // 1..127
    uint pad0;
    uint pad1;
};

const uint LENS_TSAI = 0u;
const uint LENS_BROWN_CONRADY = 1u;

struct Camera {
    vec4 camera_from_world[3]; // rows
    vec3 centre;               // in the world, mm
    uint lens;                 // LENS_*
    vec2 focal;                // pixels
    vec2 principal;            // pixels
    vec3 radial;               // k1 k2 k3; of Tsai kappa f^2 in x
    float max_radius_squared;  // of Brown-Conrady: where the radial map stops being monotone
    vec2 tangential;           // p1 p2
    uvec2 size;                // picture, pixels
    uint words;                // 32-bit words of a row of an observation's bit plane
    uint first_plane_word;     // where the view's bit planes begin, in groups of eight words
    uint first_pixel_word;     // where the view's packed bytes begin, in words
    uint area_obs;             // pixels of the observed silhouette
};

// One part in one picture, as all ways of drawing take it: nearest parts first.
struct Quad {
    ivec4 x; // corners v1 v2 v3 v4, 1/256 pixel
    ivec4 y;
    uint drawn; // 1 when every corner has an image
    uint label;
    uint part; // its place in the body
    float depth_squared;
};

// Pixels that a candidate image may touch: left, top inclusive, right, bottom exclusive, inside of the picture.
// Empty when right <= left.
struct Bounds {
    ivec2 low;
    ivec2 high;
};

// METHOD A6, without area_obs, which is the camera's.
struct Sums {
    uint area_model;
    uint overlap;
    uint edges;
    uint proximity;
};

#endif
