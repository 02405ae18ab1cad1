// The bits of doubles, low word first, for shaders that may have no doubles.
#ifndef RADAR_DOUBLE_BITS_GLSL
#define RADAR_DOUBLE_BITS_GLSL

// Bits of the double equal to the float with these bits. Converting by arithmetic may flush a small float to 0.
uvec2 doubleBits(uint bits) {
  const uint sign = bits & 0x80000000u, magnitude = bits & 0x7fffffffu;
  if (magnitude == 0) return uvec2(0, sign);
  if (magnitude >= 0x800000u) return uvec2(bits << 29, sign | ((magnitude >> 3) + (896u << 20)));
  const int leading = findMSB(magnitude);
  const uint fraction = magnitude << (23 - leading) & 0x7fffffu;
  return uvec2(fraction << 29, sign | uint(leading + 874) << 20 | fraction >> 3);
}

#endif
