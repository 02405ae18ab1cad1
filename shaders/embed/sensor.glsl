// Where a sensor is, relative to the tree over objects. Included after placement.glsl and world.glsl.

// 2^80, which bounds the coordinates.
const float kMostCoordinate = 1.2e24;

// Whether floats hold the placed mesh's coordinates, and their terms.
bool holdsTerms(Transform t, MeshRecord mesh) {
  const vec3 most = abs(mesh.origin) + max(abs(mesh.lo), abs(mesh.hi));
  bool holds = all(lessThanEqual(abs(mesh.origin), vec3(kMostCoordinate)));
  for (int row = 0; row < 3; ++row) {
    const vec4 m = uintBitsToFloat(t.bits[row]);
    holds = holds && dot(abs(m.xyz), most) + abs(m.w) <= kMostCoordinate;
  }
  return holds;
}

struct PlacedSensor {
  Placement placement;
  vec3 centre, halfExtent;  // of its box, about the anchor; Sensor::halfExtent has room for the direction's error, too
  float farthest;           // distance to the farthest object, as a sum over the axes
  int exponent;             // of the size that Sensor::scale scales to 1 to 2
  bool inRange;             // if not, the other members do not count
};

// `slack`: how far the vertices may be moved.
PlacedSensor placedSensor(Transform t, MeshRecord mesh, uint number, vec3 anchor, vec3 anchorLow, bool hasObjects, float slack) {
  PlacedSensor s;
  s.inRange = fitsFloats(t, mesh) && holdsTerms(t, mesh);
  if (!s.inRange) return s;
  const Position position = positionOf(t, mesh.origin);
  s.placement = placementOf(mesh, t, position);
  s.placement.error = 1.000001 * (s.placement.error + slack);
  s.placement.mask = 0;
  s.placement.mesh = number;
  const PlacedBox box = boxOf(t, mesh, position, anchor, anchorLow);
  s.farthest = hasObjects ? farthestFrom(box.centre) : 0.0;
  const float size = max(s.placement.size, 3.64e-12 * s.farthest);  // 2^-38
  s.inRange = s.placement.perUnit > 0.0 && size >= 8.3e-25 && s.farthest <= 8.0 * kMostCoordinate;
  s.exponent = int(floatBitsToUint(size) >> 23) - 127;
  s.centre = box.centre;
  // 2^-44 of what is placed far away.
  s.halfExtent = 1.000001 * (box.halfExtent + slack) + 5.7e-14 * (abs(position.high) + abs(anchor)) + 1e-37;
  return s;
}
