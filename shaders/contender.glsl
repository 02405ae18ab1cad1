// What the search of the contact tier and its telling share. Included after the buffers of the scene.

#ifndef RADAR_NO_DOUBLES
bool before(dvec3 p, dvec3 q) {
  return p.x < q.x || (p.x == q.x && (p.y < q.y || (p.y == q.y && p.z < q.z)));
}

// The corners of a triangle as they are placed, sorted, so that what two triangles share has the same bits in both.
void placedCorners(PreciseRows pose, uint mesh, uint slot, out dvec3 p[3]) {
  const MeshRecord record = meshes[mesh];
  const uvec3 corner = triangles[record.firstIndex / 3 + slot] + record.firstVertex;
  for (uint i = 0; i < 3; ++i) {
    const dvec3 q = dvec3(originals[corner[i]]);
    for (int k = 0; k < 3; ++k) {
      precise double sum = ((pose[k].x * q.x + pose[k].y * q.y) + pose[k].z * q.z) + pose[k].w;
      p[i][k] = sum;
    }
  }
  for (int pass = 0; pass < 3; ++pass) {
    const int i = pass & 1;
    const bool swap = before(p[i + 1], p[i]);
    const dvec3 lower = swap ? p[i + 1] : p[i], upper = swap ? p[i] : p[i + 1];
    p[i] = lower;
    p[i + 1] = upper;
  }
}
#else
#include "double_bits.glsl"

// Of x, or of 0 where that is less.
uvec2 doubleBits(float x) {
  const int bits = floatBitsToInt(x);
  return bits > 0 ? doubleBits(uint(bits)) : uvec2(0);
}
#endif
