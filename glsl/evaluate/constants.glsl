// Numbers that the shaders and the library share.

#ifndef EVALUATE_CONSTANTS
#define EVALUATE_CONSTANTS

// Largest side of a picture, pixels.
const uint LARGEST_SIDE = 16384u;
// Corners farther from the origin than this, in x or y, have no image.
const float FARTHEST_PIXEL = 16384.0;

// Most invocations of a workgroup of the projection, and how many are usual; also the most parts that a body may have there.
const uint PROJECT_GROUP = 128u;
// Invocations of a workgroup that places images in the framebuffer.
const uint PLACE_GROUP = 64u;
// Invocations of a workgroup of the comparison, and how many there may be; powers of two.
const uint COMPARE_GROUP = 128u;
const uint MOST_COMPARE_GROUP = 256u;
// How a candidate's pixel is a byte: the largest of 2 rank + edge, or the nearest label with bit 7 on edges; or, wrong where parts or
// candidates overlap, the largest label that passes the depth test, of all channels at once.
const uint PACK_MAX = 0u;
const uint PACK_DEPTH = 1u;
const uint PACK_AT_ONCE = 2u;

// Invocations of a workgroup that draws and compares an image, a row each, and how many there may be; powers of two.
const uint RASTER_GROUP = 32u;
const uint MOST_RASTER_GROUP = 256u;
// Parts whose corners, or edges, it keeps at once.
const uint RASTER_PARTS = 32u;
// Words of a row that it draws at once, and how many there may be: fewer compute the spans of wide parts more often, more make masks of
// nothing.
const uint RASTER_WORDS = 3u;
const uint MOST_RASTER_WORDS = 4u;

// Most segments that observations tell apart.
const uint MOST_SEGMENTS = 8u;
// The code of evidence that says nothing.
const uint EVIDENCE_NEUTRAL = 7u;
// Labels of parts, 0 for nothing.
const uint LABELS = 128u;
// Codes of a framebuffer's parts that the comparison by segments keeps in registers: a word holds a bit of each.
const uint SHORT_CODES = 32u;

// Invocations of a workgroup of the objective.
const uint OBJECTIVE_GROUP = 64u;

// Invocations of a workgroup of the mesh's stages.
const uint MESH_GROUP = 64u;
// The depth of a point of the mesh at camera-space z mm is 1 - MESH_NEAR / z; silhouette edges are brought nearer by the bias,
// and what is nearer than MESH_NEAREST has no image.
const float MESH_NEAR = 100.0;
const float MESH_EDGE_BIAS = 30.0;
const float MESH_NEAREST = 200.0;
// Invocations of a workgroup that draws and compares tiles of an image of a mesh; the pixels that it keeps in shared memory, of which
// every device has 16 KiB, and the most words of them in a row.
const uint MESH_RASTER_GROUP = 64u;
const uint MESH_KEYS = 3584u;
const uint MESH_WORDS = 8u;
// Vertices that a silhouette edge is drawn with: two triangles.
const uint OUTLINE_VERTICES = 6u;

#endif
