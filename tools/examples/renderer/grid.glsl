// The number of queries of a frame, and its claims, in linked lists by hashed cell. 0: none.
layout(scalar, binding = kGridCells) buffer GridCells { uint asked, heads[kBuckets]; };

uint bucketOf(ivec3 cell) {
  return (uint(cell.x) * 73856093u ^ uint(cell.y) * 19349663u ^ uint(cell.z) * 83492791u) % kBuckets;
}

uint hash(uint a, uint b) {
  uint h = a * 0x9e3779b1u ^ (b + 0x7f4a7c15u) * 0x85ebca6bu;
  h = (h ^ h >> 15) * 0x2c1b3c6du;
  h = (h ^ h >> 12) * 0x297a2d39u;
  return h ^ h >> 15;
}

// Numbers from -1 to 1 made of a hash.
vec3 random(uint h) {
  return vec3(h & 0x3ffu, h >> 10 & 0x3ffu, h >> 20 & 0x3ffu) / 511.5 - 1.0;
}
