// The frame of a direction of three doubles, given as bits, the largest of which is 1 to 2. In integers, so that all devices
// find the same (docs/method.md, "Placement and frames").

// In multiples of 2^-29, towards 0.
int scaledInteger(uvec2 x) {
  const uint significand = 0x40000000u | (x.y & 0xfffffu) << 10 | x.x >> 22;
  const int value = int(significand >> min(1024u - (x.y >> 20 & 0x7ffu), 31u));
  return x.y >> 31 != 0 ? -value : value;
}

// p q / 2^bits, downwards, 0 < bits < 32.
int shiftedProduct(int p, int q, uint bits) {
  int high, low;
  imulExtended(p, q, high, low);
  return high << (32 - bits) | int(uint(low) >> bits);
}

// 1 / |v| in multiples of 2^-30, for v in multiples of 2^-29 whose greatest component is 1 to 2. Within 2^-27 of itself.
int inverseLength(ivec3 v) {
  uint high = 0, low = 0;
  for (uint k = 0; k < 3; ++k) {
    uint squareHigh, squareLow, carry;
    umulExtended(uint(abs(v[k])), uint(abs(v[k])), squareHigh, squareLow);
    low = uaddCarry(low, squareLow, carry);
    high += squareHigh + carry;
  }
  const uint square = high << 2 | low >> 30;  // in multiples of 2^-28; below 12
  const float guess = inversesqrt(float(square) * 3.7252903e-9);
  const uint r = min(uint(guess * 1073741824.0), 0x3fffffffu);
  // A step of Newton's method doubles the number of its bits, which is at least 20. `left` is 1 - r^2 square, in multiples
  // of 2^-48.
  umulExtended(r, r, high, low);
  umulExtended(square, high << 4 | low >> 28, high, low);
  const uint leftHigh = 0x10000000u - high - (low != 0 ? 1u : 0u);
  const int left = int(leftHigh << 20 | (0u - low) >> 12);
  int correctionHigh, correctionLow;
  imulExtended(int(r), left, correctionHigh, correctionLow);
  return int(r) + (correctionHigh >> 17);
}

// Unit vectors in multiples of 2^-30.
ivec3 unitOf(ivec3 v) {
  const int r = inverseLength(v);
  return ivec3(shiftedProduct(v.x, r, 29), shiftedProduct(v.y, r, 29), shiftedProduct(v.z, r, 29));
}

int crossed(int p, int q, int r, int s) { return shiftedProduct(p, q, 30) - shiftedProduct(r, s, 30); }

// x / 2^30, rounded to nearest.
float fraction(int x) {
  const int shift = max(findMSB(uint(abs(x))) - 23, 0);
  const int magnitude = (abs(x) + ((1 << shift) >> 1)) >> shift << shift;
  return float(x < 0 ? -magnitude : magnitude) * 9.3132257e-10;
}
vec3 fractions(ivec3 v) { return vec3(fraction(v.x), fraction(v.y), fraction(v.z)); }

// Axes across the direction, across it, and along it. Each component is off by 2^-24 of itself and 2^-25.
vec3[3] axesAlong(uvec2 direction[3]) {
  const ivec3 d = ivec3(scaledInteger(direction[0]), scaledInteger(direction[1]), scaledInteger(direction[2]));
  const ivec3 size = abs(d);
  const ivec3 normal = size.x <= size.y && size.x <= size.z ? ivec3(0, d.z, -d.y)
                       : size.y <= size.z                   ? ivec3(-d.z, 0, d.x)
                                                            : ivec3(d.y, -d.x, 0);
  const ivec3 z = unitOf(d), y = unitOf(normal);
  const ivec3 x = ivec3(crossed(y.y, z.z, y.z, z.y), crossed(y.z, z.x, y.x, z.z), crossed(y.x, z.y, y.y, z.x));
  return vec3[3](fractions(x), fractions(y), fractions(z));
}

#ifndef RADAR_NO_DOUBLES
#include "root.glsl"
// The length, rounded to nearest, by the steps of exact::length; 0 where that needs exact arithmetic.
double lengthOf(dvec3 d) {
  const DoubleDouble square = plus(plus(product(d.x, d.x), product(d.y, d.y)), product(d.z, d.z));
  const double root = rootOf(square.high);
  const double rest = quotient(minus(square, product(root, root)).high, 2.0LF * root);
  const double error = 9.094947017729282e-13LF * abs(rest) + 8.077935669463161e-28LF * root;  // 2^-40, 2^-90
  const double below = root + (rest - error), above = root + (rest + error);
  return below == above ? below : 0.0LF;
}
#endif
