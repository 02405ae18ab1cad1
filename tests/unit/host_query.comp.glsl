// A host's query in std430, the other layout that radar/query.glsl promises (shared_structs.comp.glsl has the scalar one).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "radar/query.glsl"

layout(std430, binding = 0) readonly buffer Queries { RadarQuery queries[]; };

layout(local_size_x = 1) in;

void main() {}
