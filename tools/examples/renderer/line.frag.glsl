#version 460

layout(location = 0) in vec3 colour;
layout(location = 0) out vec4 shown;

void main() {
  shown = vec4(pow(colour, vec3(1.0 / 2.2)), 1.0);
}
