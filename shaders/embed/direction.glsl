// The direction of a host's query: three floats, given as bits, of which one is not 0. In integers, so that its frame needs
// no margins beyond those of the CPU's (docs/method.md, "A host's geometry").

// 2^e <= |x| < 2^(e + 1), for x other than 0.
int exponentOf(uint x) {
  const uint magnitude = x & 0x7fffffffu;
  return magnitude >= 0x800000u ? int(magnitude >> 23) - 127 : findMSB(magnitude) - 149;
}

// The greatest exponent of the components.
int exponentOf(uvec3 bits) {
  int most = -149;
  for (uint k = 0; k < 3; ++k) most = (bits[k] & 0x7fffffffu) == 0 ? most : max(most, exponentOf(bits[k]));
  return most;
}

// Bits of the double x / 2^exponent: exact.
uvec2 scaledBits(uint x, int exponent) {
  const uvec2 bits = doubleBits(x);
  return (x & 0x7fffffffu) == 0 ? bits : uvec2(bits.x, uint(int(bits.y) - exponent * 0x100000));
}

// x / 2^exponent in multiples of 2^-29, towards 0. Below 2 in magnitude.
int scaledInteger(uint x, int exponent) {
  const uint magnitude = x & 0x7fffffffu;
  if (magnitude == 0) return 0;
  const uint significand = magnitude >= 0x800000u ? (magnitude & 0x7fffffu) | 0x800000u : magnitude << (23 - findMSB(magnitude));
  const int value = int(significand << 6 >> min(exponent - exponentOf(x), 31));
  return x != magnitude ? -value : value;
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
vec3[3] axesAlong(uvec3 bits, int exponent) {
  const ivec3 d = ivec3(scaledInteger(bits.x, exponent), scaledInteger(bits.y, exponent), scaledInteger(bits.z, exponent));
  const ivec3 size = abs(d);
  const ivec3 normal = size.x <= size.y && size.x <= size.z ? ivec3(0, d.z, -d.y)
                       : size.y <= size.z                   ? ivec3(-d.z, 0, d.x)
                                                            : ivec3(d.y, -d.x, 0);
  const ivec3 z = unitOf(d), y = unitOf(normal);
  const ivec3 x = ivec3(crossed(y.y, z.z, y.z, z.y), crossed(y.z, z.x, y.x, z.z), crossed(y.x, z.y, y.y, z.x));
  return vec3[3](fractions(x), fractions(y), fractions(z));
}
