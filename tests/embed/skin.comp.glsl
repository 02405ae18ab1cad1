// Stands for a host's skinning and animation: three vertices and a transform, lifted along z.
#version 460

layout(local_size_x = 64) in;

layout(binding = 0) readonly buffer Rest { float rest[]; };
layout(binding = 1) writeonly buffer Moved { float moved[]; };
layout(push_constant) uniform Push { float lift; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i < 21) moved[i] = rest[i] + ((i < 9 && i % 3 == 2) || i == 20 ? lift : 0.0);
}
