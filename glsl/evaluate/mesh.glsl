// What the stages of the mesh model share (METHOD A4).

#ifndef EVALUATE_MESH
#define EVALUATE_MESH

// A vertex in the bind pose.
struct MeshVertex {
    vec3 position; // mm
    uint label;    // 1..127
    vec4 weights;
    uvec4 bones; // places in the order of the bone matrices
};

// An edge between (ends, opposite.x) and (ends swapped, opposite.y), both counter-clockwise from outside.
struct MeshEdge {
    uvec2 ends;
    uvec2 opposite;
};

// A vertex as one camera sees it, in 16 bytes: corners reach 2^22 units in x and y and depths take 24 bits, so that half of
// that would lose some of them.
struct Seen {
    ivec2 at;         // 1/256 pixel
    float depth;      // 1 - MESH_NEAR / z; NO_IMAGE where there is none
    float edge_depth; // the same of a point MESH_EDGE_BIAS nearer
};

const float NO_IMAGE = 4.0;

bool has_image(Seen vertex) {
    return vertex.depth != NO_IMAGE;
}

// Whether a triangle shows its outside: whether twice its area, in 1/256 pixel with y down, is negative. Differences take 24
// bits and their products 46, hence the products by halves.
bool faces_camera(ivec2 a, ivec2 b, ivec2 c) {
    ivec2 u = b - a;
    ivec2 v = c - a;
    ivec2 u1 = u >> 12, u0 = u & 4095;
    ivec2 v1 = v >> 12, v0 = v & 4095;
    int low = u0.x * v0.y - u0.y * v0.x;
    int middle = (u1.x * v0.y + u0.x * v1.y) - (u1.y * v0.x + u0.y * v1.x);
    int high = u1.x * v1.y - u1.y * v1.x;
    middle += low >> 12;
    high += middle >> 12;
    return high < 0;
}

// Whether exactly one of the triangles of an edge from p to q, whose third vertices are l and r, faces the camera.
bool is_silhouette(ivec2 p, ivec2 q, ivec2 l, ivec2 r) {
    return faces_camera(p, q, l) != faces_camera(q, p, r);
}

// The push constants of the mesh's stages.
layout(push_constant) uniform MeshBatch {
    uint candidates; // in the batch
    uint views;
    uint bones;
    uint vertices;
    uint edges;
    uint most_outlines; // room for silhouette edges of one channel
    uint triangles;
    uint first; // the batch's first candidate in the buffers of sums
} batch;

#endif
