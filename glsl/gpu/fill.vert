#version 460
// Triangles whose corners lie in a storage buffer.

struct Corner {
    vec2 position;  // clip space
    uint colour;    // RGBA8, red in the low byte
};

layout(std430, set = 0, binding = 0) readonly buffer Corners { Corner corners[]; };

layout(location = 0) out vec4 colour;

void main() {
    Corner corner = corners[gl_VertexIndex];
    gl_Position = vec4(corner.position, 0.0, 1.0);
    colour = unpackUnorm4x8(corner.colour);
}
