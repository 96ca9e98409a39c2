#version 450
#extension GL_GOOGLE_include_directive : require

// Finds the silhouette edges of every image and lists them by channel, as the counts of a draw want it: most edges are none, and
// those cost one look here instead of vertices in the draw. Workgroups in x take edges, in y images.

#include "evaluate/constants.glsl"
#include "evaluate/model.glsl"
#include "evaluate/tiles.glsl"
#include "evaluate/mesh.glsl"

layout(local_size_x = MESH_GROUP) in;

layout(std430, set = 0, binding = 0) readonly buffer Edges { MeshEdge edges[]; };
layout(std430, set = 0, binding = 1) readonly buffer AllSeen { Seen seen[]; };
layout(std430, set = 0, binding = 2) readonly buffer Placements { Placement placements[]; };
// [channel][place]: edge + edges * image
layout(std430, set = 0, binding = 3) writeonly buffer Outlines { uint outlines[]; };
layout(std430, set = 0, binding = 4) buffer Counts { uint counts[]; };

shared uint found;
shared uint first;

void main() {
    uint image = gl_WorkGroupID.y;
    uint channel = (image / batch.views) % CANDIDATES_A_TILE;
    uint index = gl_GlobalInvocationID.x;
    if (gl_LocalInvocationID.x == 0u) found = 0u;
    bool is_outline = false;
    if (index < batch.edges && placements[image].low != placements[image].high) {
        MeshEdge edge = edges[index];
        uint from = image * batch.vertices;
        Seen p = seen[from + edge.ends.x];
        Seen q = seen[from + edge.ends.y];
        Seen l = seen[from + edge.opposite.x];
        Seen r = seen[from + edge.opposite.y];
        is_outline = has_image(p) && has_image(q) && has_image(l) && has_image(r)
            && is_silhouette(p.at, q.at, l.at, r.at);
    }
    barrier();
    uint place = 0u;
    if (is_outline) place = atomicAdd(found, 1u);
    barrier();
    if (gl_LocalInvocationID.x == 0u && found > 0u) {
        first = atomicAdd(counts[4u * channel], OUTLINE_VERTICES * found) / OUTLINE_VERTICES;
    }
    barrier();
    if (is_outline) outlines[channel * batch.most_outlines + first + place] = image * batch.edges + index;
}
