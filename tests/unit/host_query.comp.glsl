// A host's query in both layouts that radar/query.glsl promises.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "engine/include/radar/query.glsl"

#ifdef SCALAR
layout(scalar, binding = 0) readonly buffer Queries { RadarQuery queries[]; };
#else
layout(std430, binding = 0) readonly buffer Queries { RadarQuery queries[]; };
#endif

layout(local_size_x = 1) in;

void main() {}
