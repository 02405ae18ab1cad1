// Unevaluated sums of two doubles and what is told of a contact with them: engine/exact/twofold.h, determinant.cpp and
// event.cpp again, operation by operation, so that both give the same bits.

// 3, but compilers do not know: unrolled, these loops take lavapipe ten seconds to compile.
uint three() { return gl_NumWorkGroups.z + 2; }

struct Twofold {
  double high;
  double low;
};

// |p| >= |q| or p = 0.
Twofold quickSum(double p, double q) {
  precise double s = p + q;
  precise double low = q - (s - p);
  return Twofold(s, low);
}

Twofold sum(double p, double q) {
  precise double s = p + q;
  precise double qPart = s - p;
  precise double low = (p - (s - qPart)) + (q - qPart);
  return Twofold(s, low);
}

Twofold product(double p, double q) {
  const double kSplit = 134217729.0LF;  // 2^27 + 1
  precise double pc = kSplit * p, qc = kSplit * q;
  precise double p1 = pc - (pc - p), q1 = qc - (qc - q);
  precise double p2 = p - p1, q2 = q - q1;
  precise double r = p * q;
  precise double low = ((p1 * q1 - r) + p1 * q2 + p2 * q1) + p2 * q2;
  return Twofold(r, low);
}

Twofold negated(Twofold p) { return Twofold(-p.high, -p.low); }

Twofold plus(Twofold p, Twofold q) {
  const Twofold s = sum(p.high, q.high), t = sum(p.low, q.low);
  precise double below = s.low + t.high;
  const Twofold v = quickSum(s.high, below);
  precise double rest = t.low + v.low;
  return quickSum(v.high, rest);
}

Twofold minus(Twofold p, Twofold q) { return plus(p, negated(q)); }

Twofold times(Twofold p, Twofold q) {
  const Twofold r = product(p.high, q.high);
  precise double low = r.low + (p.high * q.low + p.low * q.high);
  return quickSum(r.high, low);
}

struct Fine {
  Twofold value;
  double error;
};

// Triple products (w1 - w0) . ((x1 - x0) x (y1 - y0)).
struct Differences {
  dvec3 w0, w1, x0, x1, y0, y1;
};

Fine fineDeterminant(Differences d) {
  Twofold w[3], x[3], y[3];
  for (uint k = 0; k < three(); ++k) {
    w[k] = sum(d.w1[k], -d.w0[k]);
    x[k] = sum(d.x1[k], -d.x0[k]);
    y[k] = sum(d.y1[k], -d.y0[k]);
  }
  Twofold value = Twofold(0.0LF, 0.0LF);
  double magnitude = 0.0LF, size = 1.0LF;
  for (uint k = 0; k < three(); ++k) {
    const uint i = k == 2 ? 0 : k + 1, j = k == 0 ? 2 : k - 1;
    Twofold factor[2];
    for (uint side = 0; side < three() - 1; ++side) factor[side] = times(x[side == 0 ? i : j], y[side == 0 ? j : i]);
    value = plus(value, times(w[k], minus(factor[0], factor[1])));
    magnitude += abs(w[k].high) * (abs(factor[0].high) + abs(factor[1].high));
    size += abs(w[k].high);
  }
  // 2^-99, 2^-1060 and a little, since this sum is rounded as the device likes.
  return Fine(value, 1.6e-30LF * magnitude + 1.7e-300LF * size);
}

// A contact's first event, as engine/exact has it: the moving feature's vertex, the resting one's, and an edge of each.
struct Event {
  dvec3 from, to;
  dvec3 x0, x1, y0, y1;
};

Event eventOf(uint feature, dvec3 a[3], dvec3 b[3]) {
  if (feature < 3) return Event(a[feature], b[0], b[0], b[1], b[0], b[2]);
  if (feature < kFeatureEdges) return Event(a[0], b[feature - 3], a[0], a[1], a[0], a[2]);
  const uint i = (feature - kFeatureEdges) / 3, j = (feature - kFeatureEdges) % 3;
  const uint fromA = i == 1 ? 1 : 0, toA = i == 0 ? 1 : 2, fromB = j == 1 ? 1 : 0, toB = j == 0 ? 1 : 2;
  return Event(a[fromA], b[fromB], a[fromA], a[toA], b[fromB], b[toB]);
}

// What is told of an event.
struct Told {
  double s;     // its parameter
  double turn;  // less than 0: its denominator is positive
  dvec3 point;
  bool known;   // false where twofolds do not do for s
};

Told tellEvent(uint feature, Event e, dvec3 direction) {
  // The parameter's numerator and denominator; on which side of the moving edge the ends of the resting one lie.
  const dvec3 zero = dvec3(0.0LF);
  Differences what[4];
  what[0] = Differences(e.from, e.to, e.x0, e.x1, e.y0, e.y1);
  what[1] = Differences(zero, direction, e.x0, e.x1, e.y0, e.y1);
  what[2] = Differences(zero, direction, e.y0, e.x0, e.y0, e.x1);
  what[3] = Differences(zero, direction, e.y1, e.x0, e.y1, e.x1);
  Fine fine[4];
  for (uint i = 0; i < (feature < kFeatureEdges ? three() - 1 : three() + 1); ++i) fine[i] = fineDeterminant(what[i]);

  Told told;
  const Fine num = fine[0], den = fine[1];
  precise double first = num.value.high / den.value.high;
  const Twofold rest = minus(num.value, times(Twofold(first, 0.0LF), den.value));
  precise double second = rest.high / den.value.high;
  const Twofold parameter = quickSum(first, second);
  const double sure = abs(den.value.high) * (1.0LF - 4.5e-16LF) - den.error, size = abs(parameter.high);
  const double error = (num.error + size * den.error) / sure * (1.0LF + 1e-15LF) + 8.0e-31LF * size + 1e-300LF;
  told.s = parameter.high;
  told.turn = den.value.high > 0.0LF ? -1.0LF : 1.0LF;
  // The host asks for 2^-60, of an error that it rounds in its own way.
  told.known = sure > 0.0LF && error < 2.0e-19LF * size;

  // Along the motion from a vertex, at the vertex at rest, or along the edge at rest.
  precise dvec3 edge = e.y1 - e.y0;
  dvec3 origin = e.from, way = direction;
  double share = told.s;
  if (feature >= kFeatureEdges) {
    precise double part = fine[2].value.high / minus(fine[2].value, fine[3].value).high;
    share = isnan(part) || isinf(part) ? 0.0LF : clamp(part, 0.0LF, 1.0LF);
    origin = e.y0;
    way = edge;
  }
  precise dvec3 point = origin + share * way;
  told.point = feature < 3 || feature >= kFeatureEdges ? point : e.to;
  return told;
}

// Exponent of x; below -1000 or above 1000 where scaling by it could under- or overflow.
int exponentOf(double x) { return int(unpackDouble2x32(x).y >> 20 & 0x7ffu) - 1023; }
double powerOfTwo(int exponent) { return packDouble2x32(uvec2(0, uint(exponent + 1023) << 20)); }
double mostOf(double x, double y, double z) { return max(max(abs(x), abs(y)), abs(z)); }

// The square root of 1 <= x < 16 by adding, multiplying and dividing only, which every device rounds alike.
double rootOf(double x) {
  precise double root = 0.5LF * (1.0LF + x);
  for (uint i = 0; i < three() + 4; ++i) {
    precise double next = 0.5LF * (root + x / root);
    root = next;
  }
  return root;
}

bool normalOf(Event e, double turn, out dvec3 normal) {
  Twofold x[3], y[3];
  for (int k = 0; k < 3; ++k) {
    x[k] = sum(e.x1[k], -e.x0[k]);
    y[k] = sum(e.y1[k], -e.y0[k]);
  }
  const int sizeX = exponentOf(mostOf(x[0].high, x[1].high, x[2].high));
  const int sizeY = exponentOf(mostOf(y[0].high, y[1].high, y[2].high));
  const double scaleX = powerOfTwo(clamp(-sizeX, -1000, 1000)), scaleY = powerOfTwo(clamp(-sizeY, -1000, 1000));
  for (int k = 0; k < 3; ++k) {
    x[k] = Twofold(x[k].high * scaleX, x[k].low * scaleX);
    y[k] = Twofold(y[k].high * scaleY, y[k].low * scaleY);
  }
  dvec3 n;
  for (uint k = 0; k < three(); ++k) {
    const uint i = k == 2 ? 0 : k + 1, j = k == 0 ? 2 : k - 1;
    n[k] = minus(times(x[i], y[j]), times(x[j], y[i])).high;
  }
  const int size = exponentOf(mostOf(n.x, n.y, n.z));
  n *= powerOfTwo(clamp(-size, -1000, 1000));
  precise double square = (n.x * n.x + n.y * n.y) + n.z * n.z;
  const double root = rootOf(square);
  precise dvec3 unit = (turn * n) / root;
  normal = unit;
  return max(max(abs(sizeX), abs(sizeY)), abs(size)) < 1000;
}

// Where two triangles that pierce each other do so: engine/exact/common_point.cpp. `inside`: least barycentric coordinate
// of the best point so far.
void pierce(dvec3 face[3], dvec3 other[3], inout double inside, inout dvec3 best) {
  precise dvec3 x = face[1] - face[0], y = face[2] - face[0];
  precise dvec3 normal = x.yzx * y.zxy - x.zxy * y.yzx;
  precise double square = (normal.x * normal.x + normal.y * normal.y) + normal.z * normal.z;
  if (square == 0.0LF) return;
  for (uint i = 0; i < three(); ++i) {
    const dvec3 p = other[i], q = other[i == 2 ? 0 : i + 1];
    precise dvec3 pGap = p - face[0], qGap = q - face[0];
    precise double above = (normal.x * pGap.x + normal.y * pGap.y) + normal.z * pGap.z;
    precise double below = (normal.x * qGap.x + normal.y * qGap.y) + normal.z * qGap.z;
    if ((above > 0.0LF) == (below > 0.0LF) && above != 0.0LF && below != 0.0LF) continue;
    if (above == below) continue;
    precise double share = above / (above - below);
    precise dvec3 at = p + share * (q - p);
    double least = 1e300LF;
    for (uint k = 0; k < three(); ++k) {
      precise dvec3 side = face[k == 2 ? 0 : k + 1] - face[k], gap = at - face[k];
      precise dvec3 c = side.yzx * gap.zxy - side.zxy * gap.yzx;
      precise double coordinate = ((normal.x * c.x + normal.y * c.y) + normal.z * c.z) / square;
      least = min(least, coordinate);
    }
    if (least > inside) {
      inside = least;
      best = at;
    }
  }
}

bool commonPoint(dvec3 a[3], dvec3 b[3], out dvec3 point) {
  const dvec3 origin = b[0];
  double size = 0.0LF;
  for (int i = 0; i < 3; ++i) {
    precise dvec3 pa = a[i] - origin, pb = b[i] - origin;
    a[i] = pa;
    b[i] = pb;
    size = max(size, max(mostOf(pa.x, pa.y, pa.z), mostOf(pb.x, pb.y, pb.z)));
  }
  for (int i = 0; i < 3; ++i) {
    precise dvec3 pa = a[i] / size, pb = b[i] / size;
    a[i] = pa;
    b[i] = pb;
  }
  double inside = -1e-9LF;
  dvec3 best = dvec3(0.0LF);
  for (uint side = 0; side < three() - 1; ++side) {
    dvec3 face[3], other[3];
    for (uint i = 0; i < 3; ++i) {
      face[i] = side == 0 ? b[i] : a[i];
      other[i] = side == 0 ? a[i] : b[i];
    }
    pierce(face, other, inside, best);
  }
  precise dvec3 placed = best * size + origin;
  point = placed;
  return inside > -1e-9LF;
}
