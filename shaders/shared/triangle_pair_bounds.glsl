// First contact of two triangles, one of them moving, with error bounds. In double precision the motion is along `direction`
// and placed corners are exact (t = s * |direction|). In float the motion is along z, and corners are in the sensor's frame,
// each within an error.
#include "turn.glsl"

struct BoundedFloat {
  float value;
  float error;
};

// An ulp of 1: Vulkan guarantees that sums and products are rounded, but not in which direction. Numbers that may flush to 0
// are below kFlushed.
const float kUlp = 1.1920929e-7;
const float kFlushed = 2.4e-38;

// -1, 1: certain; 0: unknown.
int signOf(BoundedFloat x) { return x.value > x.error ? 1 : (x.value < -x.error ? -1 : 0); }

// The sides of corners against edges that are certain; bit 3 i + j is of corner or edge i of a, and edge or corner j of b. Edges
// are (0,1), (1,2), (2,0).
struct Sides {
  uint positive, negative;
};

void addSide(inout Sides sides, uint at, int side) {
  sides.positive |= uint(side > 0) << at;
  sides.negative |= uint(side < 0) << at;
}

// Features whose two parts may pass over each other, and those that certainly do.
struct Features {
  uint possible, certain;
};

// Of corners over a face, a corner's bit: `any` and `all` tell of its sides against the face's edges.
Features cornersOver(Sides any, Sides all, int face) {
  if (face == 0) return Features(~(any.positive & any.negative) & 7, 0);
  return face > 0 ? Features(~any.negative & 7, all.positive) : Features(~any.positive & 7, all.negative);
}

// Bits 0, 3, 6 to 0, 1, 2.
uint everyThird(uint x) { return (x | x >> 2 | x >> 4) & 7; }
uint anyOfRow(uint x) { return everyThird((x | x >> 1 | x >> 2) & 0x49); }
uint allOfRow(uint x) { return everyThird(x & x >> 1 & x >> 2 & 0x49); }
uint anyOfColumn(uint x) { return (x | x >> 3 | x >> 6) & 7; }
uint allOfColumn(uint x) { return x & x >> 3 & x >> 6 & 7; }
// Of the next corner of a, and of b.
uint nextRow(uint x) { return (x >> 3 | x << 6) & 0x1ff; }
uint nextColumn(uint x) { return (x >> 1 & 0xdb) | (x << 2 & 0x124); }

// `ofA`: corners of a against edges of b. `faceA`, `faceB`: the signs of the faces' areas.
Features featuresOf(Sides ofA, Sides ofB, int faceA, int faceB) {
  const Features a = cornersOver(Sides(anyOfRow(ofA.positive), anyOfRow(ofA.negative)),
                                Sides(allOfRow(ofA.positive), allOfRow(ofA.negative)), faceB);
  const Features b = cornersOver(Sides(anyOfColumn(ofB.positive), anyOfColumn(ofB.negative)),
                                Sides(allOfColumn(ofB.positive), allOfColumn(ofB.negative)), faceA);
  // Edges miss each other if both ends of one are on the same side of the other.
  const uint misses = (ofA.positive & nextRow(ofA.positive)) | (ofA.negative & nextRow(ofA.negative)) |
                      (ofB.positive & nextColumn(ofB.positive)) | (ofB.negative & nextColumn(ofB.negative));
  const uint knownA = ofA.positive | ofA.negative, knownB = ofB.positive | ofB.negative;
  const uint cross = knownA & nextRow(knownA) & knownB & nextColumn(knownB) & ~misses;
  return Features(a.possible | b.possible << 3 | (~misses & 0x1ff) << kFeatureEdges,
                  a.certain | b.certain << 3 | cross << kFeatureEdges);
}

float norm1(vec3 x) { return abs(x.x) + abs(x.y) + abs(x.z); }

// z of x cross y. Components of x and y are off by at most `error`.
BoundedFloat faceOf(vec3 x, vec3 y, float error) {
  const float p = x.x * y.y, q = x.y * y.x;
  const float given = error * (abs(x.x) + abs(x.y) + abs(y.x) + abs(y.y) + 2.0 * error);
  return BoundedFloat(p - q, 1.0001 * given + 6.0 * kUlp * (abs(p) + abs(q)) + 4.0 * kFlushed);
}

// Which side of edge q0 q1 the vertex p passes, seen along z.
int sideOf(vec3 q0, vec3 q1, vec3 p, float error) { return signOf(faceOf(q0 - p, q1 - p, error)); }

// gap . (x cross y)
BoundedFloat planeOf(vec3 gap, vec3 x, vec3 y, float error) {
  const vec3 p = x.yzx * y.zxy, q = x.zxy * y.yzx;
  const float g = norm1(gap), nx = norm1(x), ny = norm1(y);
  const float given = error * (nx * ny + g * (nx + ny) + 2.0 * error * (g + nx + ny) + 6.0 * error * error);
  return BoundedFloat(dot(gap, p - q),
                      1.0001 * given + 12.0 * kUlp * dot(abs(gap), abs(p) + abs(q)) + kFlushed * (6.0 + 6.0 * g));
}

// above / below, if `known`: below is certainly not 0, and the quotient and its error are less than 1e30.
BoundedFloat quotientOf(BoundedFloat above, BoundedFloat below, out bool known) {
  const float divisor = abs(below.value) - below.error;
  const bool nonzero = divisor > 0.5 * abs(below.value);
  const float value = above.value / (nonzero ? below.value : 1.0);
  const float error = (above.error + abs(value) * below.error) / (nonzero ? divisor : 1.0) * 1.0001 +
                      8.0 * kUlp * abs(value) + 4.0 * kFlushed;
  known = nonzero && abs(value) < 1e30 && error < 1e30;
  return BoundedFloat(value, error);
}

float quotient(float x, float y) { return x / y; }
float depthOf(vec3 x, float error) { return x.z; }
float reachOf(vec3 x, float error) { return abs(x.z); }
float depthSlack(float reach, float error) { return 4.0 * error + 8.0 * kUlp * reach; }
float squaredOf(float error) { return 1.0; }
float neverOf(float error) { return 3.0e38; }

#define REAL float
#define REAL3 vec3
#define BOUNDED BoundedFloat
#define IMPACT ImpactFloat
#define ALONG float
#include "triangle_pair_toi.glsl"
#undef REAL
#undef REAL3
#undef BOUNDED
#undef IMPACT
#undef ALONG

#ifndef RADAR_NO_DOUBLES
#include "bounded.glsl"
#include "divide.glsl"
#include "inner.glsl"
// A triple product of differences of doubles errs by less than 10 u times the sum of its absolute products.
const double kTripleError = 10.0LF * kHalfUlp;

int signOf(Bounded x) { return x.value > x.error ? 1 : (x.value < -x.error ? -1 : 0); }

// x . (y cross z)
Bounded planeOf(dvec3 x, dvec3 y, dvec3 z, dvec3 direction) {
  const double a0 = y.y * z.z, a1 = y.z * z.y;
  const double b0 = y.z * z.x, b1 = y.x * z.z;
  const double c0 = y.x * z.y, c1 = y.y * z.x;
  const double value = (x.x * (a0 - a1) + x.y * (b0 - b1)) + x.z * (c0 - c1);
  const double magnitude = abs(x.x) * (abs(a0) + abs(a1)) + abs(x.y) * (abs(b0) + abs(b1)) +
                           abs(x.z) * (abs(c0) + abs(c1));
  return Bounded(value, kTripleError * magnitude + kTiny);
}

Bounded faceOf(dvec3 x, dvec3 y, dvec3 direction) { return planeOf(direction, x, y, direction); }

int sideOf(dvec3 q0, dvec3 q1, dvec3 p, dvec3 direction) { return signOf(faceOf(q0 - p, q1 - p, direction)); }

Bounded quotientOf(Bounded above, Bounded below, out bool known) {
  const double divisor = abs(below.value) - below.error;
  known = divisor > 0.5LF * abs(below.value) && divides(above.value, below.value);
  const double value = known ? quotient(above.value, below.value) : 0.0LF;
  const double off = above.error + abs(value) * below.error;
  known = known && divides(off, divisor);
  const double error =
      quotient(off, known ? divisor : 1.0LF) * (1.0LF + 9.094947017729282e-13LF) + 8.881784197001252e-16LF * abs(value);
  return Bounded(value, error);
}

double depthOf(dvec3 x, dvec3 direction) { return inner(direction, x); }
double reachOf(dvec3 x, dvec3 direction) { return inner(abs(direction), abs(x)); }
double depthSlack(double reach, dvec3 direction) { return 3.552713678800501e-15LF * reach; }
double squaredOf(dvec3 direction) { return inner(direction, direction); }
double neverOf(dvec3 direction) { return kNever; }

#define REAL double
#define REAL3 dvec3
#define BOUNDED Bounded
#define IMPACT Impact
#define ALONG dvec3
#include "triangle_pair_toi.glsl"
#undef REAL
#undef REAL3
#undef BOUNDED
#undef IMPACT
#undef ALONG
#endif
