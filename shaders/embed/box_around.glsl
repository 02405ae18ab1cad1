// The box of a node whose corners are known. Measured from the centre as rounded, with room for what flushes to 0.
void boxAround(vec3 low, vec3 high, out vec3 centre, out vec3 halfExtent) {
  precise vec3 middle = 0.5 * low + 0.5 * high;
  precise vec3 reach = max(high - middle, middle - low), extent = reach * 1.000001 + 1e-37;
  centre = middle;
  halfExtent = extent;
}
