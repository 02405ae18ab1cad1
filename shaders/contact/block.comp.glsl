// Decides of the open pairs of which prove.comp does not know it whether they block (docs/exact.md, "Pairs that block"), and
// lowers their sensors' upper bounds. The decisions are those of engine/exact/blocking.cpp, in doubles with error bounds; what
// they leave open is left to the CPU.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "refined_pair.glsl"
#include "turned_corners.glsl"
#include "slack.glsl"

// ---- numbers with error bounds -----------------------------------------------------------------------------------------

// Room for the rounding of the bounds themselves.
const double kMore = 1.0001LF;

struct BoundedVector {
  dvec3 value, error;
};

Bounded minus(Bounded p, Bounded q) {
  const double value = p.value - q.value;
  return Bounded(value, (p.error + q.error + kHalfUlp * abs(value)) * kMore);
}
Bounded negative(Bounded p) { return Bounded(-p.value, p.error); }

Bounded times(Bounded p, double exactly) {
  const double value = p.value * exactly;
  return Bounded(value, (p.error * abs(exactly) + kHalfUlp * abs(value)) * kMore + kTiny);
}

BoundedVector exactly(dvec3 v) { return BoundedVector(v, dvec3(0.0LF)); }
// The difference of exact vectors.
BoundedVector difference(dvec3 p, dvec3 q) {
  const dvec3 value = p - q;
  return BoundedVector(value, kHalfUlp * kMore * abs(value));
}

// Bounds the error of a product of components, and of its addition to others.
double productError(double p, double errorP, double q, double errorQ) {
  return abs(p) * errorQ + errorP * abs(q) + errorP * errorQ + 3.0LF * kHalfUlp * abs(p * q) + kTiny;
}

Bounded inner(BoundedVector p, BoundedVector q) {
  const double error = (productError(p.value.x, p.error.x, q.value.x, q.error.x) +
                        productError(p.value.y, p.error.y, q.value.y, q.error.y)) +
                       productError(p.value.z, p.error.z, q.value.z, q.error.z);
  const double sum = (p.value.x * q.value.x + p.value.y * q.value.y) + p.value.z * q.value.z;
  return Bounded(sum, error * kMore);
}

// Component k of a product: that of the next two components of each.
Bounded crossComponent(BoundedVector p, BoundedVector q, uint k) {
  const uint i = (k + 1) % 3, j = (k + 2) % 3;
  const double error = productError(p.value[i], p.error[i], q.value[j], q.error[j]) +
                       productError(p.value[j], p.error[j], q.value[i], q.error[i]);
  const double value = p.value[i] * q.value[j] - p.value[j] * q.value[i];
  return Bounded(value, error * kMore);
}

BoundedVector crossProduct(BoundedVector p, BoundedVector q) {
  const Bounded x = crossComponent(p, q, 0), y = crossComponent(p, q, 1), z = crossComponent(p, q, 2);
  return BoundedVector(dvec3(x.value, y.value, z.value), dvec3(x.error, y.error, z.error));
}

// ---- answers -----------------------------------------------------------------------------------------------------------

// In this order, `min` of two answers is their conjunction, `max` their disjunction, and a change of sign their negation.
const int kNo = -1, kOpen = 0, kYes = 1;

int isPositive(Bounded x) { return x.value > x.error ? kYes : x.value <= -x.error ? kNo : kOpen; }

int isNotZero(BoundedVector v) { return any(greaterThan(abs(v.value), v.error)) ? kYes : kOpen; }

// ---- pairs -------------------------------------------------------------------------------------------------------------

// The pair, beside its corners.
BoundedVector direction;
Bounded slack;
// If not 0, only normals count that lead this way.
vec3 outwards = vec3(0.0);

BoundedVector selected(bool first, BoundedVector p, BoundedVector q) {
  return BoundedVector(first ? p.value : q.value, first ? p.error : q.error);
}

// The first edge, and the second.
BoundedVector edgeOf(bool ofA) { return difference(ofA ? a1 : b1, ofA ? a0 : b0); }
BoundedVector secondEdgeOf(bool ofA) { return difference(ofA ? a2 : b2, ofA ? a1 : b1); }
BoundedVector normalOf(bool ofA) { return crossProduct(edgeOf(ofA), secondEdgeOf(ofA)); }

// Of a triangle's corners along a normal.
struct Span {
  double least, most, error;
};
const Span kNoSpan = Span(1.0e300LF, -1.0e300LF, 0.0LF);

void extend(inout Span span, Bounded height) {
  span.least = min(span.least, height.value);
  span.most = max(span.most, height.value);
  span.error = max(span.error, height.error);
}

// The slack times the largest component of n.
Bounded allowedAlong(BoundedVector n) {
  const double largest = max(abs(n.value.x), max(abs(n.value.y), abs(n.value.z)));
  const double error = max(n.error.x, max(n.error.y, n.error.z));
  return Bounded(slack.value * largest, (slack.error * (largest + error) + slack.value * error +
                                         kHalfUlp * slack.value * largest) * kMore + kTiny);
}

// How far the triangles reach past each other along n and against it, beyond the slack.
struct Depths {
  Bounded forward, backward;
};

Depths depthsAlong(BoundedVector n) {
  Span spanA = kNoSpan, spanB = kNoSpan;
  const dvec3 origin = a0;
  [[dont_unroll]] for (uint i = 0; i < 3; ++i) {
    extend(spanA, inner(n, difference(a0, origin)));
    extend(spanB, inner(n, difference(b0, origin)));
    cycleA();
    cycleB();
  }
  const Bounded allowed = allowedAlong(n);
  const Bounded forward = minus(Bounded(spanB.most, spanB.error), Bounded(spanA.least, spanA.error));
  const Bounded backward = minus(Bounded(spanA.most, spanA.error), Bounded(spanB.least, spanB.error));
  return Depths(minus(forward, allowed), minus(backward, allowed));
}

// Which way n leads. The direction is off by less than 4e-7 of its greatest component.
int leadsOutwards(BoundedVector n) {
  const double along = n.value.x * double(outwards.x) + n.value.y * double(outwards.y) + n.value.z * double(outwards.z);
  const double size = (abs(n.value.x) + abs(n.value.y)) + abs(n.value.z), error = (n.error.x + n.error.y) + n.error.z;
  return isPositive(Bounded(along, 1.0e-6LF * size + 3.0LF * error));
}

// Whether n or -n keeps the triangles apart, and the motion does not go against it. `isAcross`: n is orthogonal to the
// direction.
int separates(BoundedVector n, bool isAcross) {
  const Bounded along = inner(n, direction);
  const int outward = outwards == vec3(0.0) ? kYes : leadsOutwards(n);
  const int inward = outwards == vec3(0.0) ? kYes : leadsOutwards(BoundedVector(-n.value, n.error));
  const Depths depths = depthsAlong(n);
  const int forward = min(min(-isPositive(depths.forward), outward), isAcross ? kYes : -isPositive(negative(along)));
  const int backward = min(min(-isPositive(depths.backward), inward), isAcross ? kYes : -isPositive(along));
  return min(isNotZero(n), max(forward, backward));
}

// Whether no normal keeps the triangles apart. Those that may are the two faces', the direction's products with the six edges,
// and the products of an edge of each. `apart`: what is known already.
int areInseparable(int apart) {
  int exists = kOpen;
  [[dont_unroll]] for (uint k = 0; k < 17 && apart != kYes; ++k) {
    // For each edge of a, six steps: 0 to 2 its products with b's edges; 3 the direction's with it; 4 the direction's with an
    // edge of b, the next each time; 5 a face's normal, a's first, then b's.
    const uint step = k % 6;
    const bool isPair = step < 3, isAcross = step == 3 || step == 4, faceOfA = k == 5;
    const BoundedVector edgeA = edgeOf(true), edgeB = edgeOf(false);
    const BoundedVector x = selected(isAcross, direction, selected(isPair || faceOfA, edgeA, edgeB));
    const BoundedVector y = selected(isPair || step == 4, edgeB, selected(step == 3, edgeA, secondEdgeOf(faceOfA)));
    const BoundedVector n = crossProduct(x, y);
    exists = max(exists, isNotZero(n));
    apart = max(apart, separates(n, isAcross));
    if (isPair || step == 4) cycleB();
    if (step == 5) cycleA();
  }
  return min(exists, -apart);
}

// Whether the triangles lie in one plane, up to the slack, face each other and overlap. `facing`: kYes if the product of their
// normals is negative.
int areFlush(int facing) {
  int flush = facing, thin = kNo;
  // Along both normals, then along what is orthogonal to a normal and one of its edges.
  [[dont_unroll]] for (uint k = 0; k < 8; ++k) {
    if (flush != kNo) {
      const bool ofA = k % 2 == 0, isNormal = k < 2;
      const BoundedVector normal = normalOf(ofA);
      const Depths depths = depthsAlong(selected(isNormal, normal, crossProduct(normal, edgeOf(ofA))));
      const int forward = isPositive(depths.forward), backward = isPositive(depths.backward);
      if (isNormal) thin = max(thin, min(-forward, -backward));
      if (k == 1) flush = min(flush, thin);
      if (!isNormal) flush = min(flush, min(forward, backward));
    }
    if (k % 2 == 1 && k > 1) {
      cycleA();
      cycleB();
    }
  }
  return flush;
}

// Whether the motion, which is `distance` / `length` times the direction, sinks by more than the slack into what is behind b.
// Sets `outwards`. `turn`: -1 if b is mirrored, else 1.
int sinks(int turn, double distance, double length) {
  const BoundedVector normal = normalOf(false);
  const double largest = max(abs(normal.value.x), max(abs(normal.value.y), abs(normal.value.z)));
  if (max(normal.error.x, max(normal.error.y, normal.error.z)) > 1.0e-9LF * largest) return kOpen;
  // By a power of two, to a greatest component of 1 to 2.
  const int exponent = int(unpackDouble2x32(largest).y >> 20 & 0x7ffu);
  outwards = vec3(normal.value * packDouble2x32(uvec2(0, uint(clamp(2046 - exponent, 1, 2046)) << 20))) * float(turn);
  const Bounded sinking = times(inner(direction, normal), double(-turn) * distance);
  return isPositive(minus(sinking, times(allowedAlong(normal), length)));
}

// `x` if `sign` is kYes, -x if it is kNo.
int signed(int x, int sign) { return sign == kOpen ? kOpen : x * sign; }

// ------------------------------------------------------------------------------------------------------------------------

BoundedVector rowOf(PreciseRows pose, int row) { return exactly(pose[row].xyz); }

// kYes if the pose mirrors.
int isMirroring(PreciseRows pose) {
  return isPositive(negative(inner(rowOf(pose, 0), crossProduct(rowOf(pose, 1), rowOf(pose, 2)))));
}

// A step without relative motion, in which only what crosses blocks.
bool isAtRest(Sweep sweep) { return sweep.stepPerUnit < 0.0; }

// `pose`: the object's. `isLate`: the pair counts only if it is pressed together.
int blocks(Sweep sweep, PreciseRows pose, bool isLate, out bool mayBePressed) {
  const int mirroredA = sweep.isMirrored != 0 ? kYes : kNo, mirroredB = isMirroring(pose);
  // Without mirroring, and with both mirrored, faces that face each other have normals of negative product.
  const int facing = signed(isPositive(inner(normalOf(true), normalOf(false))), -signed(mirroredA, mirroredB));
  const int flush = areFlush(facing);
  mayBePressed = flush != kNo;
  if (flush == kYes && isAtRest(sweep)) return kNo;
  if (flush == kOpen || (flush == kNo && isLate)) return flush;
  int apart = kNo;
  if (flush == kYes) {
    // b stands for the solid behind it.
    apart = -sinks(mirroredB == kYes ? -1 : 1, sweep.distance, sweep.perParameter);
    if (apart == kYes) return kNo;
    if (mirroredB == kOpen || outwards == vec3(0.0)) return kOpen;
  }
  return areInseparable(apart);
}

void main() {
  const uint place = workgroupIndex() * kContactGroup + gl_LocalInvocationID.x;
  if (place >= counts.openPairs) return;
  const uint i = refinedPairs[place].open;
  const RefinedPair c = refinedPairs[i];
  if (sweeps[c.search].ignoreLeaving == 0 || (c.flags & kPairBlocks) != 0) return;
  const float hi = uintBitsToFloat(states[c.search].hi);
  if (c.first > hi) return;
  dvec3 a[3], b[3];
  cornersInOrder(sweeps[c.search].pose, c.slotA, a);
  cornersInOrder(objects[c.object].pose, c.slotB, b);
  setCorners(a, b);
  const double way[3] = sweeps[c.search].direction;
  direction = exactly(dvec3(way[0], way[1], way[2]) * (isAtRest(sweeps[c.search]) ? 0.0LF : 1.0LF));
  slack = slackOf(sweeps[c.search], c);
  // Too late, or never because it has parted.
  const bool isLate = scaledDown(c.low, sweeps[c.search]) > hi;
  bool mayBePressed;
  const int answer = blocks(sweeps[c.search], objects[c.object].pose, isLate, mayBePressed);
  if (answer == kNo) {
    refinedPairs[i].low = kNever;
    refinedPairs[i].first = 1e38;
  } else if (mayBePressed && (c.flags & kPairMeets) == 0) {
    // Rounding may have let the triangles part, or slide past each other, but they count from the start.
    refinedPairs[i].low = 0.0LF;
  }
  // Nothing is certain of a pair that may not block. Only the CPU answers one that is pressed together and has parted, or touches
  // a little ahead: then the faces touch, whatever features come first.
  const bool meets = answer == kYes && (c.flags & kPairMeets) != 0, touches = answer == kYes && (c.flags & kPairParted) != 0;
  if (answer != kYes || touches) {
    refinedPairs[i].flags = 0;
  } else if (mayBePressed) {
    refinedPairs[i].flags &= ~kPairSharp;
  }
  if (meets || touches) lowerHi(c.search, sweeps[c.search], touches ? 0.0LF : c.at + c.error);
}
