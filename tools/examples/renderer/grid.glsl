// The claims of a frame, in linked lists by hashed cell, and the number of queries.
layout(scalar, binding = kGridCells) buffer GridCells {
  uint asked;     // queries in this frame
  uint answered;  // in all frames
  uint refused;   // answers that were no answers, in all frames
  uint spare;
  uint heads[kBuckets];
};

uint bucketOf(ivec3 cell) {
  return (uint(cell.x) * 73856093u ^ uint(cell.y) * 19349663u ^ uint(cell.z) * 83492791u) % kBuckets;
}
