// A triangle's corners in the world, in double precision, by the formula of radar.h. Included after shared/scene.glsl.
#include "shared/widen.glsl"
bool before(dvec3 p, dvec3 q) {
  return p.x < q.x || (p.x == q.x && (p.y < q.y || (p.y == q.y && p.z < q.z)));
}

void cornersInOrder(PreciseRows pose, uint slot, out dvec3 p[3]) {
  const uvec4 corner = triangleAt(slot);
  for (uint i = 0; i < 3; ++i) {
    const dvec3 q = widened(vertexBitsAt(corner[i]));
    for (int k = 0; k < 3; ++k) p[i][k] = ((pose[k].x * q.x + pose[k].y * q.y) + pose[k].z * q.z) + pose[k].w;
  }
}

// So that an edge shared by two triangles has the same bits in both.
void sortCorners(inout dvec3 p[3]) {
  for (int pass = 0; pass < 3; ++pass) {
    const int i = pass & 1;
    const bool swap = before(p[i + 1], p[i]);
    const dvec3 lower = swap ? p[i + 1] : p[i], upper = swap ? p[i] : p[i + 1];
    p[i] = lower;
    p[i + 1] = upper;
  }
}

void placedCorners(PreciseRows pose, uint slot, out dvec3 p[3]) {
  cornersInOrder(pose, slot, p);
  sortCorners(p);
}

// A function rather than an index, which would keep the corners in memory.
dvec3 picked(dvec3 p[3], uint i) { return i == 0 ? p[0] : i == 1 ? p[1] : p[2]; }
