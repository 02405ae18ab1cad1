// Quotients of doubles, rounded to nearest on every device whose sums and products are. Vulkan leaves the precision of double
// division open, and some drivers compose it from other operations: if a device does not round it correctly, it is corrected.
#ifndef RADAR_DIVIDE_GLSL
#define RADAR_DIVIDE_GLSL

layout(constant_id = 9) const bool kDivisionIsRounded = true;

uint exponentField(double x) { return unpackDouble2x32(x).y >> 20 & 0x7ffu; }

// Whether quotient() is correctly rounded: no operand, intermediate value or result is too large or too small.
bool divides(double x, double y) {
  const uint p = exponentField(x), q = exponentField(y);
  return q - 60u < 1930u && (x == 0.0LF || (p - 60u < 1930u && abs(int(p) - int(q)) < 900));
}

// Requires divides(x, y).
double correctedQuotient(double x, double y) {
  const uvec2 xBits = unpackDouble2x32(x), yBits = unpackDouble2x32(y);
  // Significands, from 1 to 2.
  const double p = packDouble2x32(uvec2(xBits.x, (xBits.y & 0xfffffu) | 0x3ff00000u));
  const double q = packDouble2x32(uvec2(yBits.x, (yBits.y & 0xfffffu) | 0x3ff00000u));
  // The inverse to 2^-21, the precision of float division on every device. Each of two steps doubles the number of bits.
  const double guess = double(1.0 / float(q));
  const double better = guess + guess * (1.0LF - q * guess);
  const double inverse = better + better * (1.0LF - q * better);
  const double near = p * inverse;
  // Dekker's product gives the remainder exactly: first to bring the error below an ulp, then to round.
  double ratio = near, rest = 0.0LF;
  for (uint i = 0; i < 2; ++i) {
    const double split = 134217729.0LF * ratio, splitQ = 134217729.0LF * q;  // 2^27 + 1
    const double high = split - (split - ratio), highQ = splitQ - (splitQ - q);
    const double low = ratio - high, lowQ = q - highQ;
    const double product = ratio * q;
    const double lost = ((high * highQ - product) + high * lowQ + low * highQ) + low * lowQ;
    const double left = (p - product) - lost;
    rest = left;
    if (i == 0) ratio = ratio + rest * inverse;
  }
  // An ulp of the quotient, times q. A quotient is never half-way between two doubles, so there are no ties.
  const uvec2 bits = unpackDouble2x32(ratio);
  const double ulp = packDouble2x32(uvec2(0, (bits.y & 0x7ff00000u) - (52u << 20))) * q;
  const int step = 2.0LF * rest > ulp ? 1 : 2.0LF * rest < -ulp ? -1 : 0;
  const uint low = bits.x + uint(step);
  const uint carry = step > 0 && low == 0 ? 1u : step < 0 && bits.x == 0 ? uint(-1) : 0u;
  const uint shift = (xBits.y >> 20 & 0x7ffu) - (yBits.y >> 20 & 0x7ffu);
  const uint sign = (xBits.y ^ yBits.y) & 0x80000000u;
  return x == 0.0LF ? packDouble2x32(uvec2(0, sign)) : packDouble2x32(uvec2(low, (bits.y + carry + (shift << 20)) | sign));
}

// 0 unless divides(x, y).
double quotient(double x, double y) {
  if (!divides(x, y)) return 0.0LF;
  if (!kDivisionIsRounded) return correctedQuotient(x, y);
  return x / y;
}

#endif
