// Every type of descriptor that kernels support, and push constants of mixed types. Each macro adds one descriptor that
// they do not support.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 64) in;

struct Pair {
  float weight;
  double value;
};

layout(binding = 9) uniform usamplerBuffer texels;
layout(binding = 1) uniform textureBuffer positions;
layout(binding = 5) uniform sampler2DArray depth;
layout(scalar, binding = 2) buffer Counted { Pair header; vec3 points[]; } counted;
layout(scalar, binding = 3) buffer Plain { dvec2 corner; uint cells[3]; };
layout(scalar, binding = 4) buffer Words { uint words[]; };

#if defined(UNIFORM_BUFFER)
layout(binding = 6) uniform Refused { uint refused; };
#elif defined(STORAGE_IMAGE)
layout(binding = 6, r32ui) uniform uimage2D refused;
#elif defined(DESCRIPTOR_ARRAY)
layout(scalar, binding = 6) buffer Refused { uint word; } refused[2];
#elif defined(OTHER_SET)
layout(scalar, set = 1, binding = 6) buffer Refused { uint refused; };
#elif defined(SAME_BINDING)
layout(scalar, binding = 4) buffer Refused { uint refused[]; };
#endif

layout(scalar, push_constant) uniform Push {
  uvec2 window;
  Pair pairs[2];
  vec3 scale;
} push;

void main() {
  words[0] = push.window.x;
}
