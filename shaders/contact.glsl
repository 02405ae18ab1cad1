// The contact of two triangles moving against each other along `direction`, in double precision with error bounds
// (docs/method.md, "A pair of triangles"). Parameters s are multiples of `direction`: t = s * |direction|.

// u = 2^-53. A triple product of differences of doubles errs by less than 10 u times the sum of its absolute products.
const double kTripleError = 10.0LF * 1.1102230246251565e-16LF;
// Below this, products may have lost bits to underflow.
const double kTiny = 1.0e-280LF;

struct Bounded {
  double value;
  double error;
};

// x . (y cross z)
Bounded triple(dvec3 x, dvec3 y, dvec3 z) {
  precise double a0 = y.y * z.z, a1 = y.z * z.y;
  precise double b0 = y.z * z.x, b1 = y.x * z.z;
  precise double c0 = y.x * z.y, c1 = y.y * z.x;
  precise double value = (x.x * (a0 - a1) + x.y * (b0 - b1)) + x.z * (c0 - c1);
  const double magnitude = abs(x.x) * (abs(a0) + abs(a1)) + abs(x.y) * (abs(b0) + abs(b1)) +
                           abs(x.z) * (abs(c0) + abs(c1));
  return Bounded(value, kTripleError * magnitude + kTiny);
}

// -1, 1: certain; 0: too close to tell.
int signOf(Bounded x) {
  return x.value > x.error ? 1 : (x.value < -x.error ? -1 : 0);
}

// What a feature is: 1 the two certainly pass over each other, 0 perhaps, -1 certainly not.
int vertexOverFace(int side0, int side1, int side2, int face) {
  if (face == 0) return (side0 > 0 || side1 > 0 || side2 > 0) && (side0 < 0 || side1 < 0 || side2 < 0) ? -1 : 0;
  if (side0 == -face || side1 == -face || side2 == -face) return -1;
  return side0 == face && side1 == face && side2 == face ? 1 : 0;
}

int edgeOverEdge(int a0, int a1, int b0, int b1) {
  if ((a0 != 0 && a0 == a1) || (b0 != 0 && b0 == b1)) return -1;
  return a0 != 0 && a1 != 0 && b0 != 0 && b1 != 0 ? 1 : 0;
}

const double kNever = 1.0e300LF;

// When a pair of triangles meets, as far as double precision can tell. Parameters are multiples of the direction.
struct Meeting {
  bool ahead;       // it certainly meets at some s >= 0, no later than `by`
  double by;        // the earliest upper end of a certain feature; below 0: it certainly meets before the start, too
  double at;        // the parameter of that feature, `error` at most off
  double error;
  uint feature;
  double earliest;  // lower end of all features that may count and have a parameter
  double others;    // the same, less the one that attains `by`
  double unknown;   // lower end of those without: parallel edges, a face edge-on
  double latest;    // upper end of all that may count
};

// Adds a feature whose plane is spanned by x and y: `gap` leads from the sensor's part to the scene's, `below` is
// direction . (x cross y). [least, most] holds direction . (scene's part - sensor's part).
void addFeature(inout Meeting m, uint feature, int state, dvec3 gap, dvec3 x, dvec3 y, Bounded below, double least,
                double most, double slack, double squared) {
  const Bounded above = triple(gap, x, y);
  const double divisor = abs(below.value) - below.error;
  const bool known = divisor > 0.5LF * abs(below.value);
  precise double at = above.value / (known ? below.value : 1.0LF);
  const double error = (above.error + abs(at) * below.error) / (known ? divisor : 1.0LF) * (1.0LF + 9.094947017729282e-13LF) +
                       8.881784197001252e-16LF * abs(at);
  const double lower = known ? at - error : (least - slack) / squared;
  const double upper = known ? at + error : (most + slack) / squared;
  if (state < 0) return;
  const bool improves = known && state > 0 && upper < m.by;
  // The feature that was best so far joins the others.
  if (known) {
    m.others = min(m.others, improves ? m.at - m.error : lower);
    m.earliest = min(m.earliest, lower);
    m.ahead = m.ahead || (state > 0 && lower >= 0.0LF);
  } else {
    m.unknown = min(m.unknown, lower);
  }
  m.latest = max(m.latest, upper);
  if (improves) {
    m.by = upper;
    m.at = at;
    m.error = error;
    m.feature = feature;
  }
}

// Which side of edge q0 q1 the vertex p passes, seen along the direction.
int sideOf(dvec3 q0, dvec3 q1, dvec3 p, dvec3 direction) { return signOf(triple(direction, q0 - p, q1 - p)); }

double least3(double x, double y, double z) { return min(x, min(y, z)); }
double most3(double x, double y, double z) { return max(x, max(y, z)); }

// a moves, b rests. Edges are (0,1), (1,2), (0,2), so that triangles whose corners are sorted give the same edges, bit for
// bit, whichever triangle an edge is found in. Written out: lavapipe keeps what is indexed by a loop in memory.
Meeting meetingOf(dvec3 a[3], dvec3 b[3], dvec3 direction) {
  // sA: vertices of a against edges of b, sB: vertices of b against edges of a; the last edge runs against the
  // triangle's sense.
  const ivec3 sA0 = ivec3(sideOf(b[0], b[1], a[0], direction), sideOf(b[1], b[2], a[0], direction), sideOf(b[0], b[2], a[0], direction));
  const ivec3 sA1 = ivec3(sideOf(b[0], b[1], a[1], direction), sideOf(b[1], b[2], a[1], direction), sideOf(b[0], b[2], a[1], direction));
  const ivec3 sA2 = ivec3(sideOf(b[0], b[1], a[2], direction), sideOf(b[1], b[2], a[2], direction), sideOf(b[0], b[2], a[2], direction));
  const ivec3 sB0 = ivec3(sideOf(a[0], a[1], b[0], direction), sideOf(a[1], a[2], b[0], direction), sideOf(a[0], a[2], b[0], direction));
  const ivec3 sB1 = ivec3(sideOf(a[0], a[1], b[1], direction), sideOf(a[1], a[2], b[1], direction), sideOf(a[0], a[2], b[1], direction));
  const ivec3 sB2 = ivec3(sideOf(a[0], a[1], b[2], direction), sideOf(a[1], a[2], b[2], direction), sideOf(a[0], a[2], b[2], direction));

  const dvec3 x0 = a[1] - a[0], x1 = a[2] - a[1], x2 = a[2] - a[0];
  const dvec3 y0 = b[1] - b[0], y1 = b[2] - b[1], y2 = b[2] - b[0];
  const Bounded faceA = triple(direction, x0, x2), faceB = triple(direction, y0, y2);
  const int signA = signOf(faceA), signB = signOf(faceB);

  // Depths along the motion, about a[0], for features without a parameter.
  const double squared = dot(direction, direction);
  const double a1 = dot(direction, x0), a2 = dot(direction, x2);
  const double b0 = dot(direction, b[0] - a[0]), b1 = dot(direction, b[1] - a[0]), b2 = dot(direction, b[2] - a[0]);
  const dvec3 span = abs(x0) + abs(x2) + abs(b[0] - a[0]) + abs(b[1] - a[0]) + abs(b[2] - a[0]);
  const double slack = 3.552713678800501e-15LF * dot(abs(direction), span);
  const double leastA = least3(0.0LF, a1, a2), mostA = most3(0.0LF, a1, a2);
  const double leastB = least3(b0, b1, b2), mostB = most3(b0, b1, b2);

  Meeting m = Meeting(false, kNever, kNever, 0.0LF, kNobody, kNever, kNever, kNever, -kNever);
  addFeature(m, 0, vertexOverFace(sA0.x, sA0.y, -sA0.z, signB), b[0] - a[0], y0, y2, faceB, leastB, mostB, slack, squared);
  addFeature(m, 1, vertexOverFace(sA1.x, sA1.y, -sA1.z, signB), b[0] - a[1], y0, y2, faceB, leastB - a1, mostB - a1, slack, squared);
  addFeature(m, 2, vertexOverFace(sA2.x, sA2.y, -sA2.z, signB), b[0] - a[2], y0, y2, faceB, leastB - a2, mostB - a2, slack, squared);
  addFeature(m, 3, vertexOverFace(sB0.x, sB0.y, -sB0.z, signA), b[0] - a[0], x0, x2, faceA, b0 - mostA, b0 - leastA, slack, squared);
  addFeature(m, 4, vertexOverFace(sB1.x, sB1.y, -sB1.z, signA), b[1] - a[0], x0, x2, faceA, b1 - mostA, b1 - leastA, slack, squared);
  addFeature(m, 5, vertexOverFace(sB2.x, sB2.y, -sB2.z, signA), b[2] - a[0], x0, x2, faceA, b2 - mostA, b2 - leastA, slack, squared);
#define EDGES(i, j, x, y, gap, bLeft, bRight, aLeft, aRight, low, high)                                                \
  addFeature(m, 6 + 3 * i + j, edgeOverEdge(bLeft, bRight, aLeft, aRight), gap, x, y, triple(direction, x, y), low, high, \
             slack, squared);
  EDGES(0, 0, x0, y0, b[0] - a[0], sB0.x, sB1.x, sA0.x, sA1.x, min(b0, b1) - max(0.0LF, a1), max(b0, b1) - min(0.0LF, a1))
  EDGES(0, 1, x0, y1, b[1] - a[0], sB1.x, sB2.x, sA0.y, sA1.y, min(b1, b2) - max(0.0LF, a1), max(b1, b2) - min(0.0LF, a1))
  EDGES(0, 2, x0, y2, b[0] - a[0], sB0.x, sB2.x, sA0.z, sA1.z, min(b0, b2) - max(0.0LF, a1), max(b0, b2) - min(0.0LF, a1))
  EDGES(1, 0, x1, y0, b[0] - a[1], sB0.y, sB1.y, sA1.x, sA2.x, min(b0, b1) - max(a1, a2), max(b0, b1) - min(a1, a2))
  EDGES(1, 1, x1, y1, b[1] - a[1], sB1.y, sB2.y, sA1.y, sA2.y, min(b1, b2) - max(a1, a2), max(b1, b2) - min(a1, a2))
  EDGES(1, 2, x1, y2, b[0] - a[1], sB0.y, sB2.y, sA1.z, sA2.z, min(b0, b2) - max(a1, a2), max(b0, b2) - min(a1, a2))
  EDGES(2, 0, x2, y0, b[0] - a[0], sB0.z, sB1.z, sA0.x, sA2.x, min(b0, b1) - max(0.0LF, a2), max(b0, b1) - min(0.0LF, a2))
  EDGES(2, 1, x2, y1, b[1] - a[0], sB1.z, sB2.z, sA0.y, sA2.y, min(b1, b2) - max(0.0LF, a2), max(b1, b2) - min(0.0LF, a2))
  EDGES(2, 2, x2, y2, b[0] - a[0], sB0.z, sB2.z, sA0.z, sA2.z, min(b0, b2) - max(0.0LF, a2), max(b0, b2) - min(0.0LF, a2))
#undef EDGES
  return m;
}
