#version 450

// A point a part, an instance an image: what a geometry stage makes the part of.

layout(location = 0) flat out uvec2 instance_and_place;

void main() {
    instance_and_place = uvec2(gl_InstanceIndex, gl_VertexIndex);
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
    // Points must have a size, drawn or not.
    gl_PointSize = 1.0;
}
