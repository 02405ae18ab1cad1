// Copies the words of a buffer to one that the host can read.
#version 460

layout(local_size_x = 64) in;

layout(binding = 0) readonly buffer From { uint from[]; };
layout(binding = 1) writeonly buffer To { uint to[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i < from.length() && i < to.length()) to[i] = from[i];
}
