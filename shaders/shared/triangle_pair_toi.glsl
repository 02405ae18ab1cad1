// Bounds the time of impact of a pair of triangles (docs/exact.md, "On the device: floats and doubles"). A template:
// triangle_pair_bounds.glsl includes it once for each precision, with REAL, REAL3, BOUNDED, IMPACT, ALONG and the functions
// with error bounds in that precision: sideOf, faceOf, planeOf, quotient, quotientOf, depthOf, depthSlack, squaredOf,
// neverOf. Parameters are multiples of the direction: ALONG in doubles, z in float.

struct IMPACT {
  bool ahead;     // the pair certainly meets at some s >= 0, no later than `by`
  REAL by;        // the earliest upper end of a certain feature; below 0: the pair certainly meets before the start, too
  REAL at;        // the parameter of that feature, off by at most `error`
  REAL error;
  uint feature;
  REAL earliest;  // lower end of all features that may count and have a parameter
  REAL others;    // the same, without the feature that attains `by`
  REAL unknown;   // lower end of the features without a parameter: parallel edges, a face edge-on
  REAL latest;    // upper end of all features that may count
};

// Adds a feature whose plane is spanned by x and y. `gap` leads from the sensor's part to the scene's; `below` is
// faceOf(x, y). The depth of the scene's part minus that of the sensor's is in [least, most].
void addFeature(inout IMPACT m, uint feature, int state, REAL3 gap, REAL3 x, REAL3 y, BOUNDED below, REAL least, REAL most,
                REAL slack, REAL squared, ALONG along) {
  bool known;
  const BOUNDED s = quotientOf(planeOf(gap, x, y, along), below, known);
  const REAL lower = known ? s.value - s.error : quotient(least - slack, squared);
  const REAL upper = known ? s.value + s.error : quotient(most + slack, squared);
  if (state < 0) return;
  const bool improves = known && state > 0 && upper < m.by;
  // The feature that was best so far joins the others.
  if (known) {
    m.others = min(m.others, improves ? m.at - m.error : lower);
    m.earliest = min(m.earliest, lower);
    m.ahead = m.ahead || (state > 0 && lower >= REAL(0));
  } else {
    m.unknown = min(m.unknown, lower);
  }
  m.latest = max(m.latest, upper);
  if (improves) {
    m.by = upper;
    m.at = s.value;
    m.error = s.error;
    m.feature = feature;
  }
}

REAL least3(REAL x, REAL y, REAL z) { return min(x, min(y, z)); }
REAL most3(REAL x, REAL y, REAL z) { return max(x, max(y, z)); }

// a moves, b rests. Edges are (0,1), (1,2), (0,2), so that an edge shared by two triangles with sorted corners has the same
// bits in both. Loops are unrolled by hand: lavapipe keeps arrays that a loop indexes in memory.
IMPACT impactOf(REAL3 a[3], REAL3 b[3], ALONG along) {
  // sA: vertices of a against edges of b; sB: vertices of b against edges of a. The last edge runs against the triangle's
  // orientation.
  const ivec3 sA0 = ivec3(sideOf(b[0], b[1], a[0], along), sideOf(b[1], b[2], a[0], along), sideOf(b[0], b[2], a[0], along));
  const ivec3 sA1 = ivec3(sideOf(b[0], b[1], a[1], along), sideOf(b[1], b[2], a[1], along), sideOf(b[0], b[2], a[1], along));
  const ivec3 sA2 = ivec3(sideOf(b[0], b[1], a[2], along), sideOf(b[1], b[2], a[2], along), sideOf(b[0], b[2], a[2], along));
  const ivec3 sB0 = ivec3(sideOf(a[0], a[1], b[0], along), sideOf(a[1], a[2], b[0], along), sideOf(a[0], a[2], b[0], along));
  const ivec3 sB1 = ivec3(sideOf(a[0], a[1], b[1], along), sideOf(a[1], a[2], b[1], along), sideOf(a[0], a[2], b[1], along));
  const ivec3 sB2 = ivec3(sideOf(a[0], a[1], b[2], along), sideOf(a[1], a[2], b[2], along), sideOf(a[0], a[2], b[2], along));

  const REAL3 x0 = a[1] - a[0], x1 = a[2] - a[1], x2 = a[2] - a[0];
  const REAL3 y0 = b[1] - b[0], y1 = b[2] - b[1], y2 = b[2] - b[0];
  const BOUNDED faceA = faceOf(x0, x2, along), faceB = faceOf(y0, y2, along);
  const int signA = signOf(faceA), signB = signOf(faceB);

  // Depths along the motion, about a[0], for features without a parameter.
  const REAL squared = squaredOf(along);
  const REAL a1 = depthOf(x0, along), a2 = depthOf(x2, along);
  const REAL b0 = depthOf(b[0] - a[0], along), b1 = depthOf(b[1] - a[0], along), b2 = depthOf(b[2] - a[0], along);
  const REAL3 span = abs(x0) + abs(x2) + abs(b[0] - a[0]) + abs(b[1] - a[0]) + abs(b[2] - a[0]);
  const REAL slack = depthSlack(span, along);
  const REAL leastA = least3(REAL(0), a1, a2), mostA = most3(REAL(0), a1, a2);
  const REAL leastB = least3(b0, b1, b2), mostB = most3(b0, b1, b2);

  const REAL never = neverOf(along);
  IMPACT m = IMPACT(false, never, never, REAL(0), kNobody, never, never, never, -never);
  addFeature(m, 0, vertexOverFace(sA0.x, sA0.y, -sA0.z, signB), b[0] - a[0], y0, y2, faceB, leastB, mostB, slack, squared, along);
  addFeature(m, 1, vertexOverFace(sA1.x, sA1.y, -sA1.z, signB), b[0] - a[1], y0, y2, faceB, leastB - a1, mostB - a1, slack, squared, along);
  addFeature(m, 2, vertexOverFace(sA2.x, sA2.y, -sA2.z, signB), b[0] - a[2], y0, y2, faceB, leastB - a2, mostB - a2, slack, squared, along);
  addFeature(m, 3, vertexOverFace(sB0.x, sB0.y, -sB0.z, signA), b[0] - a[0], x0, x2, faceA, b0 - mostA, b0 - leastA, slack, squared, along);
  addFeature(m, 4, vertexOverFace(sB1.x, sB1.y, -sB1.z, signA), b[1] - a[0], x0, x2, faceA, b1 - mostA, b1 - leastA, slack, squared, along);
  addFeature(m, 5, vertexOverFace(sB2.x, sB2.y, -sB2.z, signA), b[2] - a[0], x0, x2, faceA, b2 - mostA, b2 - leastA, slack, squared, along);
#define EDGES(i, j, x, y, gap, bLeft, bRight, aLeft, aRight, low, high)                                                \
  addFeature(m, 6 + 3 * i + j, edgeOverEdge(bLeft, bRight, aLeft, aRight), gap, x, y, faceOf(x, y, along), low, high, \
             slack, squared, along);
  EDGES(0, 0, x0, y0, b[0] - a[0], sB0.x, sB1.x, sA0.x, sA1.x, min(b0, b1) - max(REAL(0), a1), max(b0, b1) - min(REAL(0), a1))
  EDGES(0, 1, x0, y1, b[1] - a[0], sB1.x, sB2.x, sA0.y, sA1.y, min(b1, b2) - max(REAL(0), a1), max(b1, b2) - min(REAL(0), a1))
  EDGES(0, 2, x0, y2, b[0] - a[0], sB0.x, sB2.x, sA0.z, sA1.z, min(b0, b2) - max(REAL(0), a1), max(b0, b2) - min(REAL(0), a1))
  EDGES(1, 0, x1, y0, b[0] - a[1], sB0.y, sB1.y, sA1.x, sA2.x, min(b0, b1) - max(a1, a2), max(b0, b1) - min(a1, a2))
  EDGES(1, 1, x1, y1, b[1] - a[1], sB1.y, sB2.y, sA1.y, sA2.y, min(b1, b2) - max(a1, a2), max(b1, b2) - min(a1, a2))
  EDGES(1, 2, x1, y2, b[0] - a[1], sB0.y, sB2.y, sA1.z, sA2.z, min(b0, b2) - max(a1, a2), max(b0, b2) - min(a1, a2))
  EDGES(2, 0, x2, y0, b[0] - a[0], sB0.z, sB1.z, sA0.x, sA2.x, min(b0, b1) - max(REAL(0), a2), max(b0, b1) - min(REAL(0), a2))
  EDGES(2, 1, x2, y1, b[1] - a[0], sB1.z, sB2.z, sA0.y, sA2.y, min(b1, b2) - max(REAL(0), a2), max(b1, b2) - min(REAL(0), a2))
  EDGES(2, 2, x2, y2, b[0] - a[0], sB0.z, sB2.z, sA0.z, sA2.z, min(b0, b2) - max(REAL(0), a2), max(b0, b2) - min(REAL(0), a2))
#undef EDGES
  return m;
}
