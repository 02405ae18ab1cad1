// Bounds the time of impact of a pair of triangles (docs/exact.md, "On the device: floats and doubles"). A template:
// triangle_pair_bounds.glsl includes it once for each precision, with REAL, REAL3, BOUNDED, IMPACT, ALONG and the functions
// with error bounds in that precision: sideOf, faceOf, planeOf, quotient, quotientOf, depthOf, reachOf, depthSlack, squaredOf,
// neverOf. Parameters are multiples of the direction: ALONG in doubles, z in float.

struct IMPACT {
  bool ahead;    // the pair certainly meets at some s >= 0, no later than lastOf()
  bool isOver;   // all features that may count end before 0
  REAL at;       // the parameter of the certain feature of the earliest upper end, off by at most `error`
  REAL error;
  uint feature;
  REAL others;   // lower end of all other features that may count and have a parameter
  REAL unknown;  // lower end of the features without a parameter: parallel edges, a face edge-on
  uint corners;  // that may be over the other's face: bits 0 to 2 of a, 3 to 5 of b
};

// The earliest upper end of a certain feature; below 0: the pair certainly meets before the start, too.
REAL lastOf(IMPACT m) { return m.at + m.error; }
// Lower end of all features that may count and have a parameter.
REAL firstOf(IMPACT m) { return min(m.others, m.at - m.error); }

// Adds a feature that may count, and certainly does if `isCertain`, with its parameter if that is known, and its lower end.
// `isOver`: it ends before 0.
void addFeature(inout IMPACT m, uint feature, bool isCertain, bool known, BOUNDED s, REAL lower, bool isOver) {
  const bool improves = known && isCertain && s.value + s.error < lastOf(m);
  // The feature that was best so far joins the others.
  if (known) {
    m.others = min(m.others, improves ? m.at - m.error : lower);
    m.ahead = m.ahead || (isCertain && lower >= REAL(0));
  } else {
    m.unknown = min(m.unknown, lower);
  }
  m.isOver = m.isOver && isOver;
  if (improves) {
    m.at = s.value;
    m.error = s.error;
    m.feature = feature;
  }
}

REAL least3(REAL x, REAL y, REAL z) { return min(x, min(y, z)); }
REAL most3(REAL x, REAL y, REAL z) { return max(x, max(y, z)); }

// a moves, b rests. Edges are (0,1), (1,2), (0,2), so that an edge shared by two triangles with sorted corners has the same
// bits in both. Features are taken one after the other, and only those that may count: side by side they need more registers
// than GPUs have, and more code than their caches hold.
IMPACT impactOf(REAL3 a[3], REAL3 b[3], ALONG along) {
  REAL3 a0 = a[0], a1 = a[1], a2 = a[2], b0 = b[0], b1 = b[1], b2 = b[2];
  const int faceA = signOf(faceOf(a1 - a0, a2 - a0, along)), faceB = signOf(faceOf(b1 - b0, b2 - b0, along));
  Sides ofA = Sides(0, 0), ofB = Sides(0, 0);
  [[dont_unroll]] for (uint pair = 0; pair < 9; ++pair) {
    addSide(ofA, pair, sideOf(b0, b1, a0, along));
    addSide(ofB, pair, sideOf(a0, a1, b0, along));
    cycle(b0, b1, b2);
    if (pair % 3 == 2) cycle(a0, a1, a2);
  }
  const Features features = featuresOf(ofA, ofB, faceA, faceB);

  const REAL never = neverOf(along);
  IMPACT m = IMPACT(false, true, never, REAL(0), kNobody, never, never, features.possible & 63);
  for (uint rest = features.possible; rest != 0; rest &= rest - 1) {
    const uint feature = uint(findLSB(rest));
    const bool cornerA = feature < 3, edges = feature >= kFeatureEdges, cornerB = !cornerA && !edges;
    // Of the corner or edge of each.
    const uint i = edges ? (feature - kFeatureEdges) / 3 : cornerA ? feature : 0;
    const uint j = edges ? (feature - kFeatureEdges) % 3 : cornerB ? feature - 3 : 0;
    const REAL3 fromA = i == 1 ? a1 : cornerA && i == 2 ? a2 : a0, fromB = j == 1 ? b1 : cornerB && j == 2 ? b2 : b0;
    const REAL3 x = (cornerA ? b1 : i == 0 ? a1 : a2) - (cornerA ? fromB : fromA);
    const REAL3 y = (cornerB ? a2 : edges && j == 0 ? b1 : b2) - (cornerB ? fromA : fromB);
    bool known;
    const BOUNDED s = quotientOf(planeOf(fromB - fromA, x, y, along), faceOf(x, y, along), known);
    REAL lower = s.value - s.error;
    bool isOver = s.value + s.error < REAL(0);
    if (!known) {
      // By the depths of both parts along the motion, about a[0].
      const REAL depthA1 = depthOf(a1 - a0, along), depthA2 = depthOf(a2 - a0, along);
      const REAL depthB0 = depthOf(b0 - a0, along), depthB1 = depthOf(b1 - a0, along), depthB2 = depthOf(b2 - a0, along);
      const REAL reach = reachOf(a1 - a0, along) + reachOf(a2 - a0, along) + reachOf(b0 - a0, along) +
                         reachOf(b1 - a0, along) + reachOf(b2 - a0, along);
      const REAL ofA0 = i == 1 ? depthA1 : cornerA && i == 2 ? depthA2 : REAL(0);
      const REAL ofB0 = j == 1 ? depthB1 : cornerB && j == 2 ? depthB2 : depthB0;
      const REAL ofA1 = cornerA ? ofA0 : i == 0 ? depthA1 : depthA2, ofA2 = cornerB ? depthA2 : ofA1;
      const REAL ofB1 = cornerB ? ofB0 : j == 0 ? depthB1 : depthB2, ofB2 = cornerA ? depthB2 : ofB1;
      const REAL slack = depthSlack(reach, along);
      lower = quotient(least3(ofB0, ofB1, ofB2) - most3(ofA0, ofA1, ofA2) - slack, squaredOf(along));
      isOver = most3(ofB0, ofB1, ofB2) - least3(ofA0, ofA1, ofA2) + slack < REAL(0);
    }
    addFeature(m, feature, (features.certain >> feature & 1) != 0, known, s, lower, isOver);
  }
  return m;
}
