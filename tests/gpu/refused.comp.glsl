// Shaders that a kernel refuses, selected by macros.
#version 460

layout(local_size_x = 1) in;

#if defined(PUSHES_132_BYTES)
layout(binding = 0) buffer Words { uint words[]; };
layout(push_constant) uniform Push { uint pushed[33]; };
#endif

void main() {}
