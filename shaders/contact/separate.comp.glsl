// Bounds first contact of the open pairs of queries that count every contact: triangles with parallel or coinciding features, which
// refine.comp cannot tell from those that miss each other (docs/exact.md, "On the device: parallel features"). Corners are exact,
// parameters multiples of the direction.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "refined_pair.glsl"
#include "turned_corners.glsl"
#include "shared/triangle_pair_bounds.glsl"

dvec3 direction;

dvec3 crossed(dvec3 x, dvec3 y) { return dvec3(x.y * y.z - x.z * y.y, x.z * y.x - x.x * y.z, x.x * y.y - x.y * y.x); }

// Of a triangle's corners along an axis; `terms` bounds the sum of the absolute terms of each.
struct Span {
  double least, most, terms;
};

void extend(inout Span span, dvec3 n, dvec3 corner) {
  const double height = inner(n, corner);
  span = Span(min(span.least, height), max(span.most, height), max(span.terms, inner(abs(n), abs(corner))));
}

// The triangles do not meet before this, since until then n, which may be any vector, keeps them apart; 0 if it does not.
double entryAlong(dvec3 n) {
  Span spanA = Span(kNever, -kNever, 0.0LF), spanB = spanA;
  const dvec3 origin = a0;
  [[dont_unroll]] for (uint i = 0; i < 3; ++i) {
    extend(spanA, n, a0 - origin);
    extend(spanB, n, b0 - origin);
    cycleA();
    cycleB();
  }
  const double way = inner(n, direction), gap = way < 0.0LF ? spanA.least - spanB.most : spanB.least - spanA.most;
  // Each height is off by 4u of its terms, the way by 3u.
  const double certain = gap - (kRounded * (spanA.terms + spanB.terms) + kTiny);
  const double most = abs(way) + (kRounded * inner(abs(n), abs(direction)) + kTiny);
  return certain > 0.0LF && divides(certain, most) ? quotient(certain, most) * (1.0LF - kRounded) : 0.0LF;
}

// The greatest of these: along the faces' normals, and the products of an edge or the other's normal with an edge of the other or its own
// normal.
double entryOf() {
  double entry = 0.0LF;
  [[dont_unroll]] for (uint axis = 0; axis < 18; ++axis) {
    const dvec3 normalA = crossed(a1 - a0, a2 - a0), normalB = crossed(b1 - b0, b2 - b0);
    const dvec3 x = axis < 12 ? a1 - a0 : normalB, y = axis % 4 < 3 ? b1 - b0 : normalA;
    entry = max(entry, entryAlong(axis == 16 ? normalA : axis == 17 ? normalB : crossed(x, y)));
    if (axis % 4 < 3) {
      cycleB();
    } else {
      cycleA();
    }
  }
  return entry;
}

// Whether a line along the direction certainly passes inside a's triangle, or b's, through x; then `at` is where they meet, from x on.
bool passesInside(dvec3 x, bool ofA, out Bounded at) {
  int sides = 0;
  [[dont_unroll]] for (uint i = 0; i < 3; ++i) {
    sides += sideOf(ofA ? a0 : b0, ofA ? a1 : b1, x, direction);
    cycleA();
    cycleB();
  }
  if (abs(sides) != 3) return false;
  const dvec3 corner = ofA ? a0 : b0, e = (ofA ? a1 : b1) - corner, f = (ofA ? a2 : b2) - corner;
  bool known;
  at = quotientOf(planeOf(corner - x, e, f, direction), faceOf(e, f, direction), known);
  return known;
}

// Whether the triangles certainly meet, at the parameter `at`, where a line along the direction passes amid those of their corners that
// may be over the other's face.
bool meetsAmid(uint corners, out Bounded at) {
  dvec3 sum = dvec3(0.0LF);
  [[dont_unroll]] for (uint i = 0; i < 3; ++i) {
    if ((corners >> i & 1) != 0) sum += a0;
    if ((corners >> i & 8) != 0) sum += b0;
    cycleA();
    cycleB();
  }
  const dvec3 x = sum * quotient(1.0LF, double(max(bitCount(corners), 1)));
  Bounded ofA, ofB;
  if (!passesInside(x, true, ofA) || !passesInside(x, false, ofB)) return false;
  at = Bounded(ofB.value - ofA.value, (ofA.error + ofB.error + kRounded * (abs(ofA.value) + abs(ofB.value))) * (1.0LF + kRounded));
  return true;
}

void main() {
  const uint place = workgroupIndex() * kContactGroup + gl_LocalInvocationID.x;
  if (place >= counts.openPairs) return;
  const uint i = refinedPairs[place].open;
  const RefinedPair c = refinedPairs[i];
  if (sweeps[c.search].ignoreLeaving != 0) return;
  const double way[3] = sweeps[c.search].direction;
  direction = dvec3(way[0], way[1], way[2]);
  dvec3 a[3], b[3];
  placedCorners(sweeps[c.search].pose, c.slotA, a);
  placedCorners(objects[c.object].pose, c.slotB, b);
  setCorners(a, b);
  const double low = max(c.low, entryOf() * sweeps[c.search].directionLength * (1.0LF - kRounded));
  refinedPairs[i].low = low;
  refinedPairs[i].first = max(c.first, scaledDown(low, sweeps[c.search]));
  Bounded amid;
  if ((c.flags & kPairMeets) != 0 || !meetsAmid(c.flags >> kPairCorners, amid) || amid.value < amid.error) return;
  refinedPairs[i].at = amid.value;
  refinedPairs[i].error = amid.error;
  refinedPairs[i].flags = c.flags | kPairMeets;
  lowerHi(c.search, sweeps[c.search], amid.value + amid.error);
}
