// Bounds when two nodes may meet, by slabs along both meshes' axes and both nodes' normals (docs/method.md, "Pairs of nodes").
// A slab along any axis bounds the parameters at which two boxes, one of them moving, can overlap there; the intersection of
// these intervals is the result. Margins cover all rounding errors, and the clearance.
#include "shared/two_floats.glsl"

// A sensor's mesh A relative to an object's mesh B, and the reverse. Parameters are scaled distances.
struct MeshPair {
  mat3 fromA, fromB;          // B's normalised coordinates from A's, A's from B's
  vec3 offsetA, offsetB;      // origin of A in B's coordinates, and of B in A's
  vec3 inverseA, inverseB;    // 1 / velocity of A in B's coordinates and in A's
  vec3 slackA, slackB;
  vec3 velocityA, velocityB;
  float farthest;             // the two do not meet beyond this
  float leastA, leastB;       // velocities along normals are raised to this
  bool inRange;
};
// Limits, in multiples of the sensor's size. Beyond the first, products of three sizes or distances may overflow; beyond the
// second, so may cubes of errors.
const float kMostRatio = 1.0e12, kMostError = 1.0e9;

float mostOf(MatrixRows m) { return max3(vec3(sum3(abs(m.x.xyz)), sum3(abs(m.y.xyz)), sum3(abs(m.z.xyz)))); }

MeshPair meshPairOf(uint search, uint object) {
  const MatrixRows a = sensorRows(search, kTexelCoarse), fineA = sensorRows(search, kTexelFine),
                   normalsA = sensorRows(search, kTexelInverse);
  const MatrixRows b = objectRows(object, kTexelCoarse), fineB = objectRows(object, kTexelFine),
                   normalsB = objectRows(object, kTexelInverse);
  const vec4 sizesA = sensorTexel(search, kTexelError), sizesB = objectTexel(object, kTexelError);
  const vec3 direction = sensorTexel(search, kTexelDirection).xyz;
  const float scale = scaleOf(search), unscale = unscaleOf(search);
  const vec3 reachA = sensorTexel(search, kTexelReach).xyz, reachB = objectTexel(object, kTexelReach).xyz;

  const vec3 high = lastOf(b) - lastOf(a), low = lastOf(fineB) - lastOf(fineA);
  const vec3 apart = differenceInParts(lastOf(b), lastOf(fineB), lastOf(a), lastOf(fineA)) * scale;
  const float clearance = clearanceOf(search);
  const float error = scale * (sizesA.x + sizesB.x) + clearance;
  const float most = sum3(abs(apart)) + scale * (sizesA.y + sizesB.y) + clearance;

  MeshPair p;
  // Tested before multiplying. perUnit is 0 if floats cannot hold the object.
  p.inRange = objectTexel(object, kTexelOrigin).w > 0.0 && most < kMostRatio && error < kMostError &&
              max(mostOf(a), mostOf(b)) < kMostRatio * unscale &&
              max(mostOf(normalsA), mostOf(normalsB)) < kMostRatio * scale;
  const float by = p.inRange ? scale : 0.0, perBy = p.inRange ? unscale : 0.0;
  const vec3 positionError = 4.0 * kUnit * by * (abs(high) + abs(low));
  const mat3 matrixA = matrixOf(a, fineA) * by, matrixB = matrixOf(b, fineB) * by;
  const mat3 inverseA = matrixOf(normalsA) * perBy, inverseB = matrixOf(normalsB) * perBy;
  const mat3 sizeA = abs3(inverseA), sizeB = abs3(inverseB);
  const vec3 sumA = sizeA * vec3(1.0), sumB = sizeB * vec3(1.0);

  p.fromA = inverseB * matrixA;
  p.fromB = inverseA * matrixB;
  p.offsetA = -(inverseB * apart);
  p.offsetB = inverseA * apart;
  p.velocityA = inverseB * direction;
  p.velocityB = inverseA * direction;
  p.farthest = max(1.00001 * min(distanceOf(search), most), 9.5367432e-7);
  // The sum of all absolute terms along an axis.
  const vec3 spanB = reachB + sizeB * (abs3(matrixA) * reachA + abs(apart)),
             spanA = reachA + sizeA * (abs3(matrixB) * reachB + abs(apart));
  p.slackA = lastOf(normalsB) + sumB * error + sizeB * positionError + 64.0 * kUnit * spanB +
             16.0 * kUnit * p.farthest * sumB + 1e-11;
  p.slackB = lastOf(normalsA) + sumA * error + sizeA * positionError + 64.0 * kUnit * spanA +
             16.0 * kUnit * p.farthest * sumA + 1e-11;
  // The slack is included, so that quotients by a velocity stay below 1e12 times `farthest`.
  const vec3 leastA = 9.5367432e-7 / p.farthest * max(reachB + abs3(p.fromA) * reachA + p.slackA, vec3(9.5367432e-7)),
             leastB = 9.5367432e-7 / p.farthest * max(reachA + abs3(p.fromB) * reachB + p.slackB, vec3(9.5367432e-7));
  const vec3 wayA = awayFromZero(p.velocityA, leastA), wayB = awayFromZero(p.velocityB, leastB);
  p.slackA += p.farthest * abs(wayA - p.velocityA);
  p.slackB += p.farthest * abs(wayB - p.velocityB);
  p.inverseA = 1.0 / wayA;
  p.inverseB = 1.0 / wayB;
  p.leastA = max3(leastA);
  p.leastB = max3(leastB);
  return p;
}

// A lower bound of the parameters at which two nodes meet, and the sizes of both along B's axes.
struct Approach {
  float gap;  // kMiss: they do not meet
  float sizeA, sizeB;
};
const float kMiss = 3.0e38;

// A node as the other mesh meets it: `fromOther` and `offset` take the other's coordinates to the node's, in which the other
// moves against `velocity`.
struct Side {
  Node node;
  mat3 fromOther;
  vec3 offset, velocity, slack;
  float least;
};

// Adds the slab along the normal of `side`.
void addNormalSlab(inout float enter, inout float leave, Side side, Node other, float farthest) {
  const Node own = side.node;
  // The normal in the other's coordinates, as a multiple of the other's normal and a rest.
  const vec3 n = own.normal * side.fromOther;
  const float along = dot(n, other.normal);
  const vec3 rest = n - along * other.normal;
  const float between = dot(own.normal, side.offset) - own.middle;
  const float middle = along * other.middle + dot(rest, other.centre);
  const float extent = abs(along) * other.slab + dot(abs(rest), other.halfExtent) + own.slab;
  const float added = abs(along * other.middle) + dot(abs(rest), abs(other.centre)) + extent;
  const float way = dot(own.normal, side.velocity);
  const float held = way < 0.0 ? min(way, -side.least) : max(way, side.least);
  const float margin = dot(abs(own.normal), side.slack) + farthest * abs(held - way) + 64.0 * kUnit * added;
  const float gap = between + middle, reach = extent + margin, inverse = 1.0 / held;
  enter = max(enter, gap * inverse - reach * abs(inverse));
  leave = min(leave, gap * inverse + reach * abs(inverse));
}

Approach approachOf(MeshPair p, Node a, Node b, float limit) {
  // The boxes' distances and extents along B's axes and along A's.
  const vec3 gapA = b.centre - (p.fromA * a.centre + p.offsetA), gapB = p.fromB * b.centre + p.offsetB - a.centre;
  const vec3 spanA = abs3(p.fromA) * a.halfExtent, spanB = abs3(p.fromB) * b.halfExtent;
  const vec3 middleA = gapA * p.inverseA, middleB = gapB * p.inverseB;
  const vec3 reachA = (b.halfExtent + spanA + p.slackA) * abs(p.inverseA),
             reachB = (a.halfExtent + spanB + p.slackB) * abs(p.inverseB);
  float enter = max(max3(middleA - reachA), max3(middleB - reachB));
  float leave = min(min3(middleA + reachA), min3(middleB + reachB));
  // In A's coordinates, A rests and B moves against the motion; in B's coordinates, B rests and A moves.
  addNormalSlab(enter, leave, Side(a, p.fromB, p.offsetB, p.velocityB, p.slackB, p.leastB), b, p.farthest);
  addNormalSlab(enter, leave, Side(b, p.fromA, p.offsetA, -p.velocityA, p.slackA, p.leastA), a, p.farthest);
  const bool meets = enter <= leave && leave >= 0.0 && enter <= limit;
  return Approach(meets ? max(enter, 0.0) : kMiss, sum3(spanA), sum3(b.halfExtent));
}
