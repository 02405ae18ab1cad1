// Decides which refined pairs block, for the sensors that ignore all others (docs/exact.md, "Pairs that block"), and lowers
// their upper bounds. The decisions are those of engine/exact/blocking.cpp, in doubles with error bounds; what they leave open
// is left to the CPU.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "interop.h"
#include "shared/scene.glsl"
#include "placed_corners.glsl"
#include "shared/workgroup.glsl"

layout(local_size_x = kContactGroup) in;

layout(scalar, binding = kSlotStates) restrict buffer States { SearchState states[]; };
layout(scalar, binding = kSlotCounts) readonly restrict buffer Counts { SearchCounts counts; };
layout(scalar, binding = kSlotRefinedPairs) restrict buffer RefinedPairs { RefinedPair refinedPairs[]; };
layout(scalar, binding = kSlotSweeps) readonly restrict buffer Sweeps { Sweep sweeps[]; };
layout(scalar, binding = kSlotObjects) readonly restrict buffer Objects { ObjectRecord objects[]; };
layout(scalar, binding = kSlotMeshes) readonly restrict buffer Meshes { MeshRecord meshes[]; };

#include "lower_hi.glsl"

// ---- numbers with error bounds -----------------------------------------------------------------------------------------

// 2^-53, and room for the rounding of the bounds themselves.
const double kHalfUlp = 1.1102230246251565e-16LF, kMore = 1.0001LF;
// More than a product may lose to underflow.
const double kTiny = 1.0e-280LF;

struct Bounded {
  double value, error;
};
struct BoundedVector {
  dvec3 value, error;
};

#include "slack.glsl"

Bounded minus(Bounded p, Bounded q) {
  precise double value = p.value - q.value;
  return Bounded(value, (p.error + q.error + kHalfUlp * abs(value)) * kMore);
}
Bounded negative(Bounded p) { return Bounded(-p.value, p.error); }
// The greatest of three.
Bounded most(Bounded p, Bounded q, Bounded r) {
  return Bounded(max(p.value, max(q.value, r.value)), max(p.error, max(q.error, r.error)));
}

BoundedVector exactly(dvec3 v) { return BoundedVector(v, dvec3(0.0LF)); }
// The difference of exact vectors.
BoundedVector difference(dvec3 p, dvec3 q) {
  precise dvec3 value = p - q;
  return BoundedVector(value, kHalfUlp * kMore * abs(value));
}

// Bounds the error of products of components, added up to `sum`.
dvec3 productError(dvec3 p, dvec3 errorP, dvec3 q, dvec3 errorQ) {
  return abs(p) * errorQ + errorP * abs(q) + errorP * errorQ + 3.0LF * kHalfUlp * abs(p * q) + kTiny;
}

Bounded inner(BoundedVector p, BoundedVector q) {
  const dvec3 error = productError(p.value, p.error, q.value, q.error);
  precise double sum = (p.value.x * q.value.x + p.value.y * q.value.y) + p.value.z * q.value.z;
  return Bounded(sum, (error.x + error.y + error.z) * kMore);
}

BoundedVector crossProduct(BoundedVector p, BoundedVector q) {
  const dvec3 error = productError(p.value.yzx, p.error.yzx, q.value.zxy, q.error.zxy) +
                      productError(p.value.zxy, p.error.zxy, q.value.yzx, q.error.yzx);
  precise dvec3 value = p.value.yzx * q.value.zxy - p.value.zxy * q.value.yzx;
  return BoundedVector(value, error * kMore);
}

// ---- answers -----------------------------------------------------------------------------------------------------------

// In this order, `min` of two answers is their conjunction, `max` their disjunction, and a change of sign their negation.
const int kNo = -1, kOpen = 0, kYes = 1;

int isPositive(Bounded x) { return x.value > x.error ? kYes : x.value <= -x.error ? kNo : kOpen; }

int isNotZero(BoundedVector v) { return any(greaterThan(abs(v.value), v.error)) ? kYes : kOpen; }

// ---- pairs -------------------------------------------------------------------------------------------------------------

// The pair: corners about corner 0 of the sensor's triangle, edges, the direction, the slack.
BoundedVector cornersA[3], cornersB[3], edgesA[3], edgesB[3], direction;
Bounded slack;

// How far the triangles reach past each other along n and against it, beyond the slack.
struct Depths {
  Bounded forward, backward;
};

Depths depthsAlong(BoundedVector n) {
  const Bounded a0 = Bounded(0.0LF, 0.0LF), a1 = inner(n, cornersA[1]), a2 = inner(n, cornersA[2]);
  const Bounded b0 = inner(n, cornersB[0]), b1 = inner(n, cornersB[1]), b2 = inner(n, cornersB[2]);
  const double largest = max(abs(n.value.x), max(abs(n.value.y), abs(n.value.z)));
  const double error = max(n.error.x, max(n.error.y, n.error.z));
  const Bounded allowed = Bounded(slack.value * largest, (slack.error * (largest + error) + slack.value * error +
                                                          kHalfUlp * slack.value * largest) * kMore + kTiny);
  const Bounded forward = minus(most(b0, b1, b2), negative(most(negative(a0), negative(a1), negative(a2))));
  const Bounded backward = minus(most(a0, a1, a2), negative(most(negative(b0), negative(b1), negative(b2))));
  return Depths(minus(forward, allowed), minus(backward, allowed));
}

// Whether n or -n keeps the triangles apart, and the motion does not go against it. `isAcross`: n is orthogonal to the
// direction.
int separates(BoundedVector n, bool isAcross) {
  const Depths depths = depthsAlong(n);
  int forward = -isPositive(depths.forward), backward = -isPositive(depths.backward);
  if (!isAcross) {
    const Bounded along = inner(n, direction);
    forward = min(forward, -isPositive(negative(along)));
    backward = min(backward, -isPositive(along));
  }
  return min(isNotZero(n), max(forward, backward));
}

// Whether no normal keeps the triangles apart.
int areInseparable(BoundedVector normalA, BoundedVector normalB) {
  int exists = max(isNotZero(normalA), isNotZero(normalB));
  int apart = max(separates(normalA, false), separates(normalB, false));
  for (int i = 0; i < 6 && apart != kYes; ++i) {
    const BoundedVector n = crossProduct(direction, i < 3 ? edgesA[i] : edgesB[i - 3]);
    exists = max(exists, isNotZero(n));
    apart = max(apart, separates(n, true));
  }
  for (int i = 0; i < 9 && apart != kYes; ++i) {
    const BoundedVector n = crossProduct(edgesA[i / 3], edgesB[i % 3]);
    exists = max(exists, isNotZero(n));
    apart = max(apart, separates(n, false));
  }
  return min(exists, -apart);
}

int isThin(BoundedVector n) {
  const Depths depths = depthsAlong(n);
  return min(-isPositive(depths.forward), -isPositive(depths.backward));
}

int overlapAlong(BoundedVector n) {
  const Depths depths = depthsAlong(n);
  return min(isPositive(depths.forward), isPositive(depths.backward));
}

// Whether the triangles lie in one plane, face each other and overlap. `facing`: kYes if the product of their normals is
// negative.
int areFlush(int facing, BoundedVector normalA, BoundedVector normalB) {
  int flush = facing;
  if (flush != kNo) flush = min(flush, max(isThin(normalA), isThin(normalB)));
  for (int i = 0; i < 3 && flush != kNo; ++i) {
    flush = min(flush, min(overlapAlong(crossProduct(normalA, edgesA[i])), overlapAlong(crossProduct(normalB, edgesB[i]))));
  }
  return flush;
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

// `isLate`: the pair counts only if it is pressed together.
int blocks(Sweep sweep, RefinedPair c, dvec3 a[3], dvec3 b[3], bool isLate, out bool mayBePressed) {
  for (int i = 0; i < 3; ++i) {
    cornersA[i] = difference(a[i], a[0]);
    cornersB[i] = difference(b[i], a[0]);
    edgesA[i] = difference(a[(i + 1) % 3], a[i]);
    edgesB[i] = difference(b[(i + 1) % 3], b[i]);
  }
  const BoundedVector normalA = crossProduct(edgesA[0], edgesA[1]), normalB = crossProduct(edgesB[0], edgesB[1]);
  const int mirroredA = sweep.isMirrored != 0 ? kYes : kNo, mirroredB = isMirroring(objects[c.object].pose);
  // Without mirroring, and with both mirrored, faces that face each other have normals of negative product.
  const int facing = signed(isPositive(inner(normalA, normalB)), -signed(mirroredA, mirroredB));
  const int flush = areFlush(facing, normalA, normalB);
  mayBePressed = flush != kNo;
  if (flush == kYes && isAtRest(sweep)) return kNo;
  if (flush == kYes) return signed(isPositive(inner(direction, normalB)), mirroredB);
  return flush == kOpen ? kOpen : isLate ? kNo : areInseparable(normalA, normalB);
}

void main() {
  const uint place = workgroupIndex() * kContactGroup + gl_LocalInvocationID.x;
  if (place >= counts.openPairs) return;
  const uint i = refinedPairs[place].open;
  const RefinedPair c = refinedPairs[i];
  const Sweep sweep = sweeps[c.sensor];
  const float hi = uintBitsToFloat(states[c.sensor].hi);
  if (c.first > hi) return;
  dvec3 a[3], b[3];
  cornersInOrder(sweep.pose, c.slotA, a);
  cornersInOrder(objects[c.object].pose, c.slotB, b);
  const dvec3 way = dvec3(sweep.direction[0], sweep.direction[1], sweep.direction[2]);
  direction = exactly(isAtRest(sweep) ? dvec3(0.0LF) : way);
  slack = slackOf(sweep, c);
  // Too late, or never because it has parted.
  const bool isLate = scaledDown(c.low, sweep) > hi;
  bool mayBePressed;
  const int answer = blocks(sweep, c, a, b, isLate, mayBePressed);
  if (answer == kNo) {
    refinedPairs[i].low = 1.0e200LF;
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
  if (meets || touches) lowerHi(c.sensor, sweep, touches ? 0.0LF : c.at + c.error);
}
