// Converts floats to doubles by their bits: a device's own conversion may flush subnormal floats to 0, and optimisers take
// double(float(x)) for x, even where NoContraction forbids other algebra.
#ifndef RADAR_WIDEN_GLSL
#define RADAR_WIDEN_GLSL
#include "double_bits.glsl"

double widened(float x) { return packDouble2x32(doubleBits(floatBitsToUint(x))); }

dvec3 widened(uvec3 floats) {
  return dvec3(packDouble2x32(doubleBits(floats.x)), packDouble2x32(doubleBits(floats.y)),
               packDouble2x32(doubleBits(floats.z)));
}

// x as the sum of two floats, within 2^-46 of itself, whatever the rounding direction.
void split(double x, out float high, out float low) {
  high = float(x);
  const double rest = x - widened(high);
  low = float(rest);
}

#endif
