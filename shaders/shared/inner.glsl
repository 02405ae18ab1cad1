// The inner product of doubles, by single operations: within a dot() a driver may fuse them.
#ifndef RADAR_INNER_GLSL
#define RADAR_INNER_GLSL

double inner(dvec3 p, dvec3 q) { return (p.x * q.x + p.y * q.y) + p.z * q.z; }

#endif
