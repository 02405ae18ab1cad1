// The contact of two triangles moving against each other along `direction`, in double precision with error bounds
// (docs/method.md, "A pair of triangles"). Parameters s are multiples of `direction`: t = s * |direction|.

// u = 2^-53. A triple product of differences of doubles errs by less than 10 u times the sum of its absolute products.
const double kTripleError = 10.0LF * 1.1102230246251565e-16LF;
// 2^-21.
const double kTolerance = 4.76837158203125e-7LF;
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

struct Contact {
  bool meets;      // certainly, at some s >= 0, and all that could come earlier is within tolerance
  double s;        // an upper bound of the first such s, within tolerance of it
  uint feature;
};

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

// First contact of a (moving) with b (still). The answer may be later than the true first s by kTolerance of it, or of
// `size` (in multiples of direction) if that is more; a pair that needs more slack counts as not decided.
Contact firstContact(dvec3 a[3], dvec3 b[3], dvec3 direction, double size) {
  // sideB[i][j]: on which side of edge i of a vertex j of b passes; sideA[i][j]: vertex j of a and edge i of b. As signs
  // of one predicate, so that all features judge alike.
  int sideB[3][3], sideA[3][3];
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      sideB[i][j] = signOf(triple(direction, a[i] - b[j], a[(i + 1) % 3] - b[j]));
      sideA[i][j] = signOf(triple(direction, b[i] - a[j], b[(i + 1) % 3] - a[j]));
    }
  }
  const int faceA = signOf(triple(direction, a[1] - a[0], a[2] - a[0]));
  const int faceB = signOf(triple(direction, b[1] - b[0], b[2] - b[0]));

  if (faceA == 0 && faceB == 0) return Contact(false, 0.0LF, kNobody);

  double earliest = 1.0e300LF;  // lower bound of everything that may meet
  double s = 1.0e300LF;
  bool ahead = false;  // something certain lies at s >= 0: the pair's interval reaches the motion
  uint attained = kNobody;
  for (uint f = 0; f < kFeatures; ++f) {
    // The feature's plane (normal = x cross y) and a vector from the sensor's part to the scene's.
    int state;
    dvec3 x, y, gap;
    if (f < 3) {
      const int i = int(f);
      state = vertexOverFace(sideA[0][i], sideA[1][i], sideA[2][i], faceB);
      x = b[1] - b[0];
      y = b[2] - b[0];
      gap = b[0] - a[i];
    } else if (f < kFeatureEdges) {
      const int i = int(f) - 3;
      state = vertexOverFace(sideB[0][i], sideB[1][i], sideB[2][i], faceA);
      x = a[1] - a[0];
      y = a[2] - a[0];
      gap = b[i] - a[0];
    } else {
      const int i = (int(f) - 6) / 3, j = (int(f) - 6) % 3;
      state = edgeOverEdge(sideB[i][j], sideB[i][(j + 1) % 3], sideA[j][i], sideA[j][(i + 1) % 3]);
      x = a[(i + 1) % 3] - a[i];
      y = b[(j + 1) % 3] - b[j];
      gap = b[j] - a[i];
    }
    if (state < 0) continue;
    const Bounded above = triple(gap, x, y), below = triple(direction, x, y);
    const double divisor = abs(below.value) - below.error;
    // Parallel edges, or a face edge-on: no parameter to compute, and none is needed. Where such parts overlap in the
    // projection, the ends of the overlap are vertices on a face, or crossings of the edge-on face's outline, and those
    // features bound it (docs/method.md).
    if (divisor <= 0.5LF * abs(below.value)) continue;
    precise double at = above.value / below.value;
    const double error = (above.error + abs(at) * below.error) / divisor * (1.0LF + 9.094947017729282e-13LF) + 8.881784197001252e-16LF * abs(at);
    earliest = min(earliest, at - error);
    if (state > 0) {
      ahead = ahead || at - error >= 0.0LF;
      if (at + error < s) {
        s = at + error;
        attained = f;
      }
    }
  }
  s = max(s, 0.0LF);
  const bool meets = ahead && s - max(earliest, 0.0LF) <= kTolerance * max(size, s);
  return Contact(meets, s, attained);
}
