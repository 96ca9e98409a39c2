#version 460
// Gives the first corner the colour that the triangle has here.

struct Corner {
    vec2 position;  // clip space
    uint colour;    // RGBA8, red in the low byte
};

layout(std430, set = 0, binding = 0) writeonly buffer Corners { Corner corners[]; };

layout(location = 0) in vec4 colour;
layout(location = 0) out vec4 pixel;

void main() {
    corners[0].colour = packUnorm4x8(colour);
    pixel = colour;
}
