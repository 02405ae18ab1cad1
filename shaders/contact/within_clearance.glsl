// When two triangles, one of them in motion, come within a given distance of each other, in floats: engine/cpu/approach.cpp has
// the same search in doubles (docs/exact.md, "Clearance"). Included after triangle_pair.glsl.

struct WithinClearance {
  float low;  // farther apart before this; kMiss: also later, up to the limit
  float by;   // certainly that near by this; kMiss: unknown
};

// Steps converge quadratically, except where the triangles only just come that near.
const uint kClearanceSteps = 10;
// Iterations of all loops in one search: of each step, itself, 9 + 1 pairs of edges, 6 + 1 corners.
const uint kClearanceIterations = 18 * kClearanceSteps + 1;
// Of the product of two unit vectors.
const float kRateError = 64.0 * kUlp;

// Keeps the shorter of two vectors. A NaN is never kept: devices may compare it as they like, but its bits are the greatest.
void offer(inout vec3 gap, vec3 other) {
  if (floatBitsToUint(dot(other, other)) < floatBitsToUint(dot(gap, gap))) gap = other;
}

float share(float part, float whole) { return whole > 0.0 ? clamp(part / whole, 0.0, 1.0) : 0.0; }

// Any points of the two edges will do for the bounds, but the nearest make them tight.
void offerEdges(inout vec3 gap, vec3 a0, vec3 a1, vec3 b0, vec3 b1) {
  const vec3 x = a1 - a0, y = b1 - b0, r = b0 - a0, n = cross(x, y);
  const float xx = dot(x, x), yy = dot(y, y);
  float s = share(dot(cross(r, y), n), dot(n, n));
  float t = share(dot(s * x - r, y), yy);
  s = share(dot(r + t * y, x), xx);
  t = share(dot(s * x - r, y), yy);
  offer(gap, (r + t * y) - s * x);
}

// From a corner to the face's point nearest to it, if that is inside the face. `turn`: 1 or -1.
void offerCorner(inout vec3 gap, vec3 corner, vec3 face0, vec3 face1, vec3 face2, float turn) {
  const vec3 x = face1 - face0, y = face2 - face0, r = corner - face0, n = cross(x, y);
  const float nn = dot(n, n), v = dot(cross(r, y), n), w = dot(cross(x, r), n);
  if (nn > 0.0 && v >= 0.0 && w >= 0.0 && v + w <= nn) offer(gap, turn * ((v / nn) * x + (w / nn) * y - r));
}

RADAR_EXCHANGE(vec3)

vec3 nearestGap(vec3 a[3], vec3 b[3]) {
  vec3 a0 = a[0], a1 = a[1], a2 = a[2], b0 = b[0], b1 = b[1], b2 = b[2];
  vec3 gap = b0 - a0;
  [[dont_unroll]] for (uint pair = 0; pair < 9; ++pair) {
    offerEdges(gap, a0, a1, b0, b1);
    cycle(b0, b1, b2);
    if (pair % 3 == 2) cycle(a0, a1, a2);
  }
  // The corners of a over b; then the triangles change places.
  [[dont_unroll]] for (uint corner = 0; corner < 6; ++corner) {
    offerCorner(gap, a0, b0, b1, b2, corner < 3 ? 1.0 : -1.0);
    cycle(a0, a1, a2);
    if (corner == 2) {
      exchange(a0, b0);
      exchange(a1, b1);
      exchange(a2, b2);
    }
  }
  return gap;
}

float farthestOf(vec3 corners[3]) { return max(norm1(corners[0]), max(norm1(corners[1]), norm1(corners[2]))); }

WithinClearance withinClearance(PlacedTriangle a, PlacedTriangle b, float clearance, float limit) {
  const float sizeA = farthestOf(a.corners), atStart = max(sizeA, farthestOf(b.corners));
  // Of a distance between the two; the frame's axes are rounded, too.
  const float given = differenceError(a, b) + 8.0 * kUlp * clearance + kFlushed;
  const float ahead = min(b.corners[0].z, min(b.corners[1].z, b.corners[2].z)) -
                      max(a.corners[0].z, max(a.corners[1].z, a.corners[2].z));
  WithinClearance found = WithinClearance(max(ahead - clearance - given - 8.0 * kUlp * (atStart + clearance), 0.0), kMiss);
  float t = found.low, end = kMiss, step = 0.0;
  for (uint i = 0; i < kClearanceSteps; ++i) {
    if (found.low > limit || found.low >= end) return WithinClearance(kMiss, kMiss);
    const vec3 moved[3] = vec3[3](b.corners[0] - vec3(0.0, 0.0, t), b.corners[1] - vec3(0.0, 0.0, t), b.corners[2] - vec3(0.0, 0.0, t));
    const vec3 gap = nearestGap(a.corners, moved);
    const float length = sqrt(dot(gap, gap));
    const float error = given + 4.0 * kUlp * (atStart + t) + 64.0 * kUlp * max(sizeA, farthestOf(moved));
    if (length + error <= clearance) {
      found.by = t;
      break;
    }
    // The plane across the gap keeps the triangles apart until the motion has used up its distance.
    const vec3 n = gap / (length > 0.0 ? length : 1.0);
    const float from = max(dot(n, a.corners[0]), max(dot(n, a.corners[1]), dot(n, a.corners[2])));
    const float to = min(dot(n, moved[0]), min(dot(n, moved[1]), dot(n, moved[2])));
    const float least = to - from - error;
    float next;
    if (least > clearance) {
      const float spare = (least - clearance) * (1.0 - 16.0 * kUlp), forward = n.z + kRateError, backward = kRateError - n.z;
      const float before = backward > 0.0 ? t - spare / backward : -kMiss, after = forward > 0.0 ? t + spare / forward : kMiss;
      if (before <= found.low) {
        found.low = max(found.low, after * (1.0 - 8.0 * kUlp));
      } else if (after >= end || forward <= 0.0) {
        end = min(end, before * (1.0 + 8.0 * kUlp));
      } else {
        break;
      }
      step = 4.0 * error;
      next = min(min(found.low + step, 0.5 * found.low + 0.5 * end), limit);
      if (next == t) break;
    } else {
      // Rounding leaves open whether the triangles are that near now.
      step = max(2.0 * step, 4.0 * error);
      next = min(min(t + step, 0.5 * t + 0.5 * end), limit);
      if (n.z + kRateError <= 0.0 || next <= t) break;
    }
    t = next;
  }
  if (found.low > limit || found.low >= end) found = WithinClearance(kMiss, kMiss);
  return found;
}
