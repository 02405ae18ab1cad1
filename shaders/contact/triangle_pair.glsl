// Pairs of triangles in the sensor's frame, in float, and a test for those that may meet (docs/method.md, "Pairs of triangles
// in float"). Triangles are placed about points near them, so that neither the size of their meshes nor the distance between
// the meshes costs precision.

#include "shared/two_floats.glsl"

// Places triangles of a leaf: at turned * (q - anchor) + offset.
struct MeshFrame {
  vec3 origin;  // q = (vertex - origin) * perUnit
  float perUnit;
  vec3 anchor;  // normalised coordinates, rounded to 8 bits
  mat3 turned;
  vec3 offset;
  vec3 columns;  // column sums of the absolute scaled matrix
  float error;   // of a vertex on any axis, without the part due to its distance from the anchor
};

// Of the sensor's leaf, whose offset is 0, and of the scene's.
struct PairFrame {
  MeshFrame a, b;
};

// One row of B's anchor minus A's, in the world. Products of the matrices' leading 16 bits and the anchors' 8 are exact.
float rowApart(vec4 coarseA, vec4 fineA, vec3 anchorA, vec4 coarseB, vec4 fineB, vec3 anchorB) {
  float high = coarseB.w, low = 0.0;
  precise float fromA = -coarseA.w;
  addExactly(high, low, fromA);
  for (int k = 0; k < 3; ++k) {
    precise float ofB = coarseB[k] * anchorB[k], ofA = -coarseA[k] * anchorA[k];
    addExactly(high, low, ofB);
    addExactly(high, low, ofA);
  }
  precise float sum = high + (low + ((fineB.w - fineA.w) + (dot(fineB.xyz, anchorB) - dot(fineA.xyz, anchorA))));
  return sum;
}

vec3 normalised(vec3 vertex, vec3 origin, float perUnit) { return (vertex - origin) * perUnit; }
vec3 anchorOf(vec3 q) { return floor(q * 128.0 + 0.5) * 0.0078125; }

// `vertexA` and `vertexB` are vertices of the leaves.
PairFrame pairFrameOf(uint search, uint object, vec3 vertexA, vec3 vertexB) {
  const MatrixRows a = sensorRows(search, kTexelCoarse), fineA = sensorRows(search, kTexelFine);
  const MatrixRows b = objectRows(object, kTexelCoarse), fineB = objectRows(object, kTexelFine);
  const vec4 originA = sensorTexel(search, kTexelOrigin), originB = objectTexel(object, kTexelOrigin);
  const mat3 frame = rows(sensorTexel(search, kTexelAcross).xyz, sensorTexel(search, kTexelUpwards).xyz,
                          sensorTexel(search, kTexelAlong).xyz);
  const float scale = scaleOf(search);
  const float slack = slackShare(search) * scale * (sensorTexel(search, kTexelError).x + objectTexel(object, kTexelError).x);
  const vec3 anchorA = anchorOf(normalised(vertexA, originA.xyz, originA.w)),
             anchorB = anchorOf(normalised(vertexB, originB.xyz, originB.w));
  const vec3 apart = vec3(rowApart(a.x, fineA.x, anchorA, b.x, fineB.x, anchorB),
                          rowApart(a.y, fineA.y, anchorA, b.y, fineB.y, anchorB),
                          rowApart(a.z, fineA.z, anchorA, b.z, fineB.z, anchorB)) * scale;
  const mat3 matrixA = matrixOf(a, fineA) * scale, matrixB = matrixOf(b, fineB) * scale;
  const float errorA = 1.75 * scale * sensorTexel(search, kTexelError).x + 1e-30 + slack;
  const float errorB = 1.75 * scale * objectTexel(object, kTexelError).x + 24.0 * kUnit * sum3(abs(apart)) + 1e-30;
  const vec3 columnsA = vec3(1.0) * abs3(matrixA), columnsB = vec3(1.0) * abs3(matrixB);
  return PairFrame(MeshFrame(originA.xyz, originA.w, anchorA, frame * matrixA, vec3(0.0), columnsA, errorA),
                   MeshFrame(originB.xyz, originB.w, anchorB, frame * matrixB, frame * apart, columnsB, errorB));
}

struct PlacedTriangle {
  vec3 corners[3];
  float error;
};

PlacedTriangle placedTriangle(MeshFrame f, uint slot) {
  const uvec4 corner = triangleAt(slot);
  const vec3 q0 = normalised(vertexAt(corner.x), f.origin, f.perUnit) - f.anchor,
             q1 = normalised(vertexAt(corner.y), f.origin, f.perUnit) - f.anchor,
             q2 = normalised(vertexAt(corner.z), f.origin, f.perUnit) - f.anchor;
  PlacedTriangle t;
  t.corners = vec3[3](f.turned * q0 + f.offset, f.turned * q1 + f.offset, f.turned * q2 + f.offset);
  t.error = f.error + 24.0 * kUnit * dot(f.columns, max(abs(q0), max(abs(q1), abs(q2))));
  return t;
}

// Bound on the error of differences of coordinates of the two triangles.
float differenceError(PlacedTriangle a, PlacedTriangle b) { return 2.0 * (a.error + b.error); }

// Whether the whole other triangle is certainly on the edge's outer side, seen along the motion. `turn`: the sign of the area
// of the edge's own triangle, 0 if it is uncertain.
bool edgeSeparates(vec2 from, vec2 to, float turn, PlacedTriangle other, float error, float clearance) {
  const vec2 e = to - from, d0 = other.corners[0].xy - from, d1 = other.corners[1].xy - from, d2 = other.corners[2].xy - from;
  const float s0 = turn * (e.x * d0.y - e.y * d0.x), s1 = turn * (e.x * d1.y - e.y * d1.x), s2 = turn * (e.x * d2.y - e.y * d2.x);
  const float edge = abs(e.x) + abs(e.y);
  const float farthest = max(abs(d0.x) + abs(d0.y), max(abs(d1.x) + abs(d1.y), abs(d2.x) + abs(d2.y)));
  const float margin = 1.0001 * (error * (edge + farthest + 2.0 * error) + clearance * (edge + 2.0 * error)) +
                       6.0 * kUlp * edge * farthest + 4.0 * kFlushed;
  return max(s0, max(s1, s2)) < -margin;
}

// Two edges of a triangle, and the area between them as seen along the motion.
struct Face {
  vec3 x, y;
  BoundedFloat area;
};

// How long the other triangle certainly stays beyond the face's plane: kMiss if until `limit`, or if it is behind it; no more than
// 0 if that is not known. `gaps` lead from the sensor's triangle to the scene's; one of their ends is a corner of the other
// triangle.
float beyondUntil(Face face, vec3 gaps[3], float error, float clearance, float limit) {
  const vec3 x = face.x, y = face.y, g0 = gaps[0], g1 = gaps[1], g2 = gaps[2], n = cross(x, y);
  const float turn = float(signOf(face.area));
  const float h0 = turn * dot(g0, n), h1 = turn * dot(g1, n), h2 = turn * dot(g2, n);
  const float nx = norm1(x), ny = norm1(y), g = max(norm1(g0), max(norm1(g1), norm1(g2)));
  const float margin = 1.0001 * error * (nx * ny + g * (nx + ny) + 2.0 * error * (g + nx + ny) + 6.0 * error * error) +
                       12.0 * kUlp * g * nx * ny + kFlushed * (6.0 + 6.0 * g) +
                       clearance * (norm1(n) + 2.0001 * error * (nx + ny + 3.0 * error) + 16.0 * kUlp * nx * ny);
  const float reached = 1.00001 * limit * (abs(face.area.value) + face.area.error) + margin;
  const float perTime = 1.00001 * (abs(face.area.value) + face.area.error);
  const float least = min(h0, min(h1, h2));
  // So that the quotient is not too large, either.
  const bool never = least > reached || max(h0, max(h1, h2)) < -margin;
  return turn == 0.0 ? 0.0 : never ? kMiss : (least - margin) / perTime;
}

// When a pair may meet first, or come as near as the clearance: not before that, which is at least 0; kMiss if not at or before
// `limit`. Cheap.
float meetsFrom(PlacedTriangle a, PlacedTriangle b, float clearance, float limit) {
  const float error = differenceError(a, b), room = error + clearance;
  const vec3 a0 = a.corners[0], a1 = a.corners[1], a2 = a.corners[2], b0 = b.corners[0], b1 = b.corners[1], b2 = b.corners[2];
  const vec3 lowA = min(a0, min(a1, a2)), highA = max(a0, max(a1, a2)), lowB = min(b0, min(b1, b2)), highB = max(b0, max(b1, b2));
  // Comparisons are exact, and `error` already exceeds what rounding costs the sums with `room`.
  const float between = lowB.z - highA.z - room;
  const bool near = all(lessThanEqual(lowA.xy, highB.xy + room)) && all(lessThanEqual(lowB.xy, highA.xy + room)) &&
                    highB.z + room >= lowA.z && between <= limit;
  const Face faceA = Face(a1 - a0, a2 - a0, faceOf(a1 - a0, a2 - a0, error)),
             faceB = Face(b1 - b0, b2 - b0, faceOf(b1 - b0, b2 - b0, error));
  const float turnA = float(signOf(faceA.area)), turnB = float(signOf(faceB.area));
  const bool apart = edgeSeparates(a0.xy, a1.xy, turnA, b, error, clearance) ||
                     edgeSeparates(a1.xy, a2.xy, turnA, b, error, clearance) ||
                     edgeSeparates(a2.xy, a0.xy, turnA, b, error, clearance) ||
                     edgeSeparates(b0.xy, b1.xy, turnB, a, error, clearance) ||
                     edgeSeparates(b1.xy, b2.xy, turnB, a, error, clearance) ||
                     edgeSeparates(b2.xy, b0.xy, turnB, a, error, clearance);
  const float beyondA = beyondUntil(faceA, vec3[3](b0 - a0, b1 - a0, b2 - a0), error, clearance, limit),
              beyondB = beyondUntil(faceB, vec3[3](b0 - a0, b0 - a1, b0 - a2), error, clearance, limit);
  return near && !apart ? max(max(between, 0.0), max(beyondA, beyondB)) : kMiss;
}
