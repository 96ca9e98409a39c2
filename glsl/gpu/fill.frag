#version 460
// Fills a triangle with its corners' colour.

layout(location = 0) in vec4 colour;
layout(location = 0) out vec4 pixel;

void main() {
    pixel = colour;
}
