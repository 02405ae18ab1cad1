// Computes the numbers of the contacts that resolve.comp is certain of, in the arithmetic of engine/exact, with the same bits.
// Where doubles do not suffice, lists the pairs that may be first as unresolved.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "answers.glsl"
#include "root.glsl"
#include "shared/turn.glsl"

// Unevaluated sums of two doubles; the operations are those of engine/exact/determinant.cpp and event.cpp, in the same order.

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

// The components of a vector, as sums of two doubles.
struct FineVector {
  DoubleDouble x, y, z;
};

FineVector fine(dvec3 v) {
  return FineVector(DoubleDouble(v.x, 0.0LF), DoubleDouble(v.y, 0.0LF), DoubleDouble(v.z, 0.0LF));
}
FineVector difference(dvec3 p, dvec3 q) { return FineVector(sum(p.x, -q.x), sum(p.y, -q.y), sum(p.z, -q.z)); }

RADAR_CYCLE(DoubleDouble)
void cycle(inout FineVector v) { cycle(v.x, v.y, v.z); }

// w . (x cross y), component by component.
Fine fineDeterminant(FineVector w, FineVector x, FineVector y) {
  const double size = 1.0LF + ((abs(w.x.high) + abs(w.y.high)) + abs(w.z.high));
  DoubleDouble value = DoubleDouble(0.0LF, 0.0LF);
  double magnitude = 0.0LF;
  [[dont_unroll]] for (uint i = 0; i < 3; ++i) {
    const DoubleDouble over = times(x.y, y.z), under = times(x.z, y.y);
    value = plus(value, times(w.x, minus(over, under)));
    magnitude += abs(w.x.high) * (abs(over.high) + abs(under.high));
    cycle(w);
    cycle(x);
    cycle(y);
  }
  // The CPU's bound of 2^-99 and 2^-1060, increased because the device may round this sum in any direction.
  return Fine(value, 1.6e-30LF * magnitude + 1.7e-300LF * size);
}

// A contact's first event, as in engine/exact: a vertex of the moving feature, one of the resting feature, and two edges that
// span the plane of contact.
struct Event {
  dvec3 from, to;
  dvec3 x0, x1, y0, y1;
};

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
  // The sides of the moving edge on which the ends of the resting edge lie; then the parameter's numerator and denominator.
  const bool isEdges = feature >= kFeatureEdges;
  Fine num = Fine(DoubleDouble(0.0LF, 0.0LF), 0.0LF), den = num;
  double share = 0.0LF;  // of the resting edge, up to the contact
  [[dont_unroll]] for (uint i = isEdges ? 0 : 2; i < 4; ++i) {
    FineVector w = fine(direction), x, y;
    if (i < 2) {
      const dvec3 end = i == 0 ? e.y0 : e.y1;
      x = difference(e.x0, end);
      y = difference(e.x1, end);
    } else {
      x = difference(e.x1, e.x0);
      y = difference(e.y1, e.y0);
    }
    if (i == 2) w = difference(e.to, e.from);
    num = den;
    den = fineDeterminant(w, x, y);
    if (i == 1) {
      const double both = minus(num.value, den.value).high;
      share = both == 0.0LF ? 0.0LF : clamp(soundQuotient(num.value.high, both), 0.0LF, 1.0LF);
    }
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
  const dvec3 edge = e.y1 - e.y0;
  const dvec3 point = isEdges ? e.y0 + share * edge : e.from + details.s * direction;
  details.point = feature < 3 || isEdges ? point : e.to;
  return details;
}

// Exponent of x; below -1000 or above 1000 where scaling by it could under- or overflow.
int exponentOf(double x) { return int(unpackDouble2x32(x).y >> 20 & 0x7ffu) - 1023; }
double powerOfTwo(int exponent) { return packDouble2x32(uvec2(0, uint(exponent + 1023) << 20)); }
double mostOf(double x, double y, double z) { return max(max(abs(x), abs(y)), abs(z)); }

FineVector scaled(FineVector v, double by) {
  return FineVector(DoubleDouble(v.x.high * by, v.x.low * by), DoubleDouble(v.y.high * by, v.y.low * by),
                    DoubleDouble(v.z.high * by, v.z.low * by));
}

// Returns false if only the CPU finds it.
bool normalOf(Event e, double turn, out dvec3 normal) {
  FineVector x = difference(e.x1, e.x0), y = difference(e.y1, e.y0);
  const int sizeX = exponentOf(mostOf(x.x.high, x.y.high, x.z.high)), sizeY = exponentOf(mostOf(y.x.high, y.y.high, y.z.high));
  x = scaled(x, powerOfTwo(clamp(-sizeX, -1000, 1000)));
  y = scaled(y, powerOfTwo(clamp(-sizeY, -1000, 1000)));
  dvec3 n = dvec3(0.0LF);
  double products = 0.0LF;
  [[dont_unroll]] for (uint i = 0; i < 3; ++i) {
    const DoubleDouble over = times(x.y, y.z), under = times(x.z, y.y);
    n = dvec3(n.y, n.z, minus(over, under).high);
    products = max(products, abs(over.high) + abs(under.high));
    cycle(x);
    cycle(y);
  }
  const bool isPrecise = products < 1099511627776.0LF * mostOf(n.x, n.y, n.z);  // 2^40
  const int size = exponentOf(mostOf(n.x, n.y, n.z));
  n *= powerOfTwo(clamp(-size, -1000, 1000));
  const double square = (n.x * n.x + n.y * n.y) + n.z * n.z;
  const double root = rootOf(square);
  normal = dvec3(soundQuotient(turn * n.x, root), soundQuotient(turn * n.y, root), soundQuotient(turn * n.z, root));
  return isPrecise && max(max(abs(sizeX), abs(sizeY)), abs(size)) < 1000;
}

// Sets the refined pair's first contact, at s > 0. Returns whether its numbers certainly have the CPU's bits.
bool setHit(RefinedPair c, inout RadarResult r) {
  const uint feature = c.flags & 0xffu;
  dvec3 a[3], b[3];
  cornersOf(c, true, a);
  cornersOf(c, false, b);
  const dvec3 direction = dvec3(sweeps[s].direction[0], sweeps[s].direction[1], sweeps[s].direction[2]);
  const Event e = eventOf(feature, a, b);
  const EventDetails details = describeEvent(feature, e, direction);
  const double t = details.s * sweeps[s].perParameter;
  const double slack = kRounded * t;
  const double distance = sweeps[s].distance;
  const double first = min(t, distance);
  const double below = t - slack, above = t + slack;
  // The pair's only contact then is inside both features: others certainly begin later.
  r.featureA = feature < 3 ? RADAR_FEATURE_vertex : feature < kFeatureEdges ? RADAR_FEATURE_face : RADAR_FEATURE_edge;
  r.featureB = feature < 3 ? RADAR_FEATURE_face : feature < kFeatureEdges ? RADAR_FEATURE_vertex : RADAR_FEATURE_edge;
  r.t = bitsOf(first);
  r.lo = bitsOf(min(max(below, 0.0LF), first));
  r.hi = bitsOf(min(above, distance));
  r.fraction = bitsOf(soundQuotient(first, distance));
  dvec3 normal;
  const bool unit = normalOf(e, details.turn, normal);
  const dvec3 point = details.point + t * dvec3(sweeps[s].drift[0], sweeps[s].drift[1], sweeps[s].drift[2]);
  r.point = bitsOf(point);
  r.normal = bitsOf(normal);
  r.gap = uvec2(0);
  return sound && details.known && unit && t > 1e-270LF && t * (1.0LF + kRounded) < distance;
}

void main() {
  s = workgroupIndex() * kContactGroup + gl_LocalInvocationID.x;
  if (s >= push.sensors || heads[s] == kNobody) return;
  const uint described = refinedPairs[heads[s]].left;
  if (described == kNobody) return;
  const RefinedPair c = refinedPairs[described];
  const uvec3 name = nameOf(c);
  RadarResult r = nothing(RADAR_STATUS_hit, kNoNumber);
  r.detected = RADAR_DETECTED_yes;
  r.object = name.x;
  r.triB = name.y;
  r.triA = name.z;
  if (!setHit(c, r)) {
    const SearchState state = states[s];
    r = leaveThese(summarise(hiOf(state)), hasMet(state));
  }
  results[sweeps[s].result] = r;
}
