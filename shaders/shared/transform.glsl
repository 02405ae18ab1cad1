// A transform in two floats per entry: a host's, or the double-precision pose of an object or a query.
#include "double_bits.glsl"

struct Transform {
  uvec4 bits[3];  // of floats
  vec4 low[3];    // what a double has beyond them, within 2^-46 of itself, 2^-23 of it at most; of a host's transform 0
  bool isFinite;
  bvec3 flushes;  // the row has an entry that a device may flush to 0, or a part of one
};

// A power of two, -126 <= exponent <= 127.
float twoTo(int exponent) { return uintBitsToFloat(uint(exponent + 127) << 23); }

struct Parts {
  uint bits;
  float low;
  bool flushes;
};

// Of a double: its leading 24 bits, and what follows.
Parts partsOf(uvec2 d) {
  const uint sign = d.y & 0x80000000u;
  const int exponent = int(d.y >> 20 & 0x7ffu) - 1023;
  if (exponent > 127) return Parts(sign | 0x7f800000u, 0.0, false);
  if (exponent < -126) return Parts(sign, 0.0, ((d.y & 0x7fffffffu) | d.x) != 0);
  const uint bits = sign | uint(exponent + 127) << 23 | (d.y & 0xfffffu) << 3 | d.x >> 29;
  precise float rest = float(d.x & 0x1fffffffu) * 1.8626451e-9;  // 2^-29
  precise float low = exponent < -103 ? 0.0 : rest * twoTo(exponent - 23);
  return Parts(bits, sign != 0 ? -low : low, exponent < -70);
}

uvec2 entryOf(PreciseRows pose, uint row, uint k) {
#ifdef RADAR_NO_DOUBLES
  const uvec4 two = pose[2 * row + k / 2];
  return k % 2 == 0 ? two.xy : two.zw;
#else
  return unpackDouble2x32(pose[row][k]);
#endif
}

Transform transformOf(PreciseRows pose) {
  Transform t;
  t.isFinite = true;
  for (uint row = 0; row < 3; ++row) {
    t.flushes[row] = false;
    for (uint k = 0; k < 4; ++k) {
      const Parts parts = partsOf(entryOf(pose, row, k));
      t.bits[row][k] = parts.bits;
      t.low[row][k] = parts.low;
      t.isFinite = t.isFinite && (parts.bits & 0x7f800000u) != 0x7f800000u;
      if (k < 3) t.flushes[row] = t.flushes[row] || parts.flushes;
    }
  }
  return t;
}
