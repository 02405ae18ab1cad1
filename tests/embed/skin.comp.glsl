// Stands for a host's skinning and animation: lifts three vertices of 8 floats each and 20 transforms along z.
#version 460

layout(local_size_x = 64) in;

layout(binding = 0) readonly buffer Rest { float rest[]; };
layout(binding = 1) writeonly buffer Skinned { float skinned[]; };
layout(binding = 2) writeonly buffer Transforms { float transforms[]; };
layout(push_constant) uniform Push { float lift; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i < 24) {
    skinned[i] = rest[i] + (i % 8 == 2 ? lift : 0.0);
  } else if (i < 264) {
    transforms[i - 24] = rest[i] + (i % 12 == 11 ? lift : 0.0);
  }
}
