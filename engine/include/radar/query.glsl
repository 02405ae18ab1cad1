// The layout of the queries that a host's shader writes for radar::HostQueries (radar/host.h, which explains the
// members): 80 bytes, the same in std430 and scalar layout.
//
//     #extension GL_GOOGLE_include_directive : require
//     #include "radar/query.glsl"
//     layout(std430, binding = 0) writeonly buffer Queries { RadarQuery queries[]; };
#ifndef RADAR_QUERY_GLSL
#define RADAR_QUERY_GLSL

struct RadarQuery {
  vec4 worldFromMesh[3];  // rows; w: the position
  vec3 direction;
  float distance;
  uint mesh;
  uint mask;
  uint exclude;           // an object, or RADAR_NO_EXCLUSION
  uint flags;             // RADAR_ANY_HIT, or 0
};

const uint RADAR_NO_EXCLUSION = 0xffffffffu;
const uint RADAR_ANY_HIT = 1;

#endif
