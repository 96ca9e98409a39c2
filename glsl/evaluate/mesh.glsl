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

// The push constants of the mesh's stages.
layout(push_constant) uniform MeshBatch {
    uint candidates; // in the batch
    uint views;
    uint bones;
    uint vertices;
    uint edges;
    uint most_outlines; // room for silhouette edges of one channel
} batch;

#endif
