// The numbers of a contact, computed with unevaluated sums of two doubles. The operations are those of
// engine/exact/determinant.cpp and event.cpp, in the same order, so that both give the same bits.

// 3, hidden from compilers: unrolled, the loops below take lavapipe ten seconds to compile. They rotate variables instead of
// indexing arrays, which lavapipe keeps in memory.
uint three() { return gl_NumWorkGroups.z + 2; }

#include "shared/divide.glsl"
#include "shared/double_double.glsl"

// Whether every quotient so far was correctly rounded.
bool sound = true;
double soundQuotient(double x, double y) {
  sound = sound && divides(x, y);
  return quotient(x, y);
}

struct Fine {
  DoubleDouble value;
  double error;
};

// Triple products (w1 - w0) . ((x1 - x0) x (y1 - y0)).
struct Differences {
  dvec3 w0, w1, x0, x1, y0, y1;
};

Fine fineDeterminant(Differences d) {
  const DoubleDoubleVector w = sum(d.w1, -d.w0), x = sum(d.x1, -d.x0), y = sum(d.y1, -d.y0);
  const DoubleDoubleVector over = times(yzx(x), zxy(y)), under = times(zxy(x), yzx(y)), all = times(w, minus(over, under));
  DoubleDouble value = plus(DoubleDouble(0.0LF, 0.0LF), DoubleDouble(all.high.x, all.low.x));
  value = plus(value, DoubleDouble(all.high.y, all.low.y));
  value = plus(value, DoubleDouble(all.high.z, all.low.z));
  const double magnitude = sum3(abs(w.high) * (abs(over.high) + abs(under.high))), size = 1.0LF + sum3(abs(w.high));
  // The CPU's bound of 2^-99 and 2^-1060, increased because the device may round this sum in any direction.
  return Fine(value, 1.6e-30LF * magnitude + 1.7e-300LF * size);
}

// A contact's first event, as in engine/exact: a vertex of the moving feature, one of the resting feature, and two edges that
// span the plane of contact.
struct Event {
  dvec3 from, to;
  dvec3 x0, x1, y0, y1;
};

dvec3 picked(dvec3 p[3], uint i) { return i == 0 ? p[0] : (i == 1 ? p[1] : p[2]); }

Event eventOf(uint feature, dvec3 a[3], dvec3 b[3]) {
  if (feature < 3) return Event(picked(a, feature), b[0], b[0], b[1], b[0], b[2]);
  if (feature < kFeatureEdges) return Event(a[0], picked(b, feature - 3), a[0], a[1], a[0], a[2]);
  const uint i = (feature - kFeatureEdges) / 3, j = (feature - kFeatureEdges) % 3;
  const dvec3 fromA = i == 1 ? a[1] : a[0], toA = i == 0 ? a[1] : a[2], fromB = j == 1 ? b[1] : b[0],
              toB = j == 0 ? b[1] : b[2];
  return Event(fromA, fromB, fromA, toA, fromB, toB);
}

// An event's numbers.
struct EventDetails {
  double s;     // its parameter
  double turn;  // sign of the normal; -1: the denominator is positive
  dvec3 point;
  bool known;   // false where double-doubles are not precise enough for s
};

EventDetails describeEvent(uint feature, Event e, dvec3 direction) {
  // The parameter's numerator and denominator, and the sides of the moving edge on which the ends of the resting edge lie.
  const dvec3 zero = dvec3(0.0LF);
  Differences what = Differences(e.from, e.to, e.x0, e.x1, e.y0, e.y1);
  Fine num = Fine(DoubleDouble(0.0LF, 0.0LF), 0.0LF), den = num, side0 = num, side1 = num;
  for (uint i = 0; i < (feature < kFeatureEdges ? three() - 1 : three() + 1); ++i) {
    num = den;
    den = side0;
    side0 = side1;
    side1 = fineDeterminant(what);
    what.w0 = zero;
    what.w1 = direction;
    if (i == 1) {
      what = Differences(zero, direction, e.y0, e.x0, e.y0, e.x1);
    } else if (i == 2) {
      what = Differences(zero, direction, e.y1, e.x0, e.y1, e.x1);
    }
  }
  if (feature < kFeatureEdges) {
    num = side0;
    den = side1;
  }

  EventDetails details;
  const double first = soundQuotient(num.value.high, den.value.high);
  const DoubleDouble rest = minus(num.value, times(DoubleDouble(first, 0.0LF), den.value));
  const double second = soundQuotient(rest.high, den.value.high);
  const DoubleDouble parameter = quickSum(first, second);
  const double sure = abs(den.value.high) * (1.0LF - 4.5e-16LF) - den.error, size = abs(parameter.high);
  const double error = soundQuotient(num.error + size * den.error, sure) * (1.0LF + 1e-15LF) + 8.0e-31LF * size + 1e-300LF;
  details.s = parameter.high;
  details.turn = den.value.high > 0.0LF ? -1.0LF : 1.0LF;
  // Below the CPU's limit of 2^-60, since the CPU rounds the error differently.
  details.known = sure > 0.0LF && error < 2.0e-19LF * size;

  // The contact point: along the motion from the moving vertex, at the resting vertex, or on the resting edge.
  precise dvec3 edge = e.y1 - e.y0;
  dvec3 origin = e.from, way = direction;
  double share = details.s;
  if (feature >= kFeatureEdges) {
    const double both = minus(side0.value, side1.value).high;
    share = both == 0.0LF ? 0.0LF : clamp(soundQuotient(side0.value.high, both), 0.0LF, 1.0LF);
    origin = e.y0;
    way = edge;
  }
  precise dvec3 point = origin + share * way;
  details.point = feature < 3 || feature >= kFeatureEdges ? point : e.to;
  return details;
}

// Exponent of x; below -1000 or above 1000 where scaling by it could under- or overflow.
int exponentOf(double x) { return int(unpackDouble2x32(x).y >> 20 & 0x7ffu) - 1023; }
double powerOfTwo(int exponent) { return packDouble2x32(uvec2(0, uint(exponent + 1023) << 20)); }
double mostOf(double x, double y, double z) { return max(max(abs(x), abs(y)), abs(z)); }

// The square root of 1 <= x < 16, by sums, products and quotients only, which have the same bits on the CPU.
double rootOf(double x) {
  precise double root = 0.5LF * (1.0LF + x);
  for (uint i = 0; i < three() + 4; ++i) {
    precise double next = 0.5LF * (root + quotient(x, root));
    root = next;
  }
  return root;
}

// Returns false if only the CPU finds it.
bool normalOf(Event e, double turn, out dvec3 normal) {
  DoubleDoubleVector x = sum(e.x1, -e.x0), y = sum(e.y1, -e.y0);
  const int sizeX = exponentOf(mostOf(x.high.x, x.high.y, x.high.z)), sizeY = exponentOf(mostOf(y.high.x, y.high.y, y.high.z));
  const double scaleX = powerOfTwo(clamp(-sizeX, -1000, 1000)), scaleY = powerOfTwo(clamp(-sizeY, -1000, 1000));
  x = DoubleDoubleVector(x.high * scaleX, x.low * scaleX);
  y = DoubleDoubleVector(y.high * scaleY, y.low * scaleY);
  const DoubleDoubleVector over = times(yzx(x), zxy(y)), under = times(zxy(x), yzx(y));
  dvec3 n = minus(over, under).high;
  const dvec3 products = abs(over.high) + abs(under.high);
  const bool isPrecise = mostOf(products.x, products.y, products.z) < 1099511627776.0LF * mostOf(n.x, n.y, n.z);  // 2^40
  const int size = exponentOf(mostOf(n.x, n.y, n.z));
  n *= powerOfTwo(clamp(-size, -1000, 1000));
  precise double square = (n.x * n.x + n.y * n.y) + n.z * n.z;
  const double root = rootOf(square);
  normal = dvec3(soundQuotient(turn * n.x, root), soundQuotient(turn * n.y, root), soundQuotient(turn * n.z, root));
  return isPrecise && max(max(abs(sizeX), abs(sizeY)), abs(size)) < 1000;
}
