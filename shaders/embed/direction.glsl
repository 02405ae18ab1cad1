// The direction of a host's query: three floats, given as bits, of which one is not 0.

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
