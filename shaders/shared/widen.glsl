// Converts floats to doubles by their bits: a device's own conversion may flush subnormal floats to 0.
#ifndef RADAR_WIDEN_GLSL
#define RADAR_WIDEN_GLSL
#include "double_bits.glsl"

dvec3 widened(uvec3 floats) {
  return dvec3(packDouble2x32(doubleBits(floats.x)), packDouble2x32(doubleBits(floats.y)),
               packDouble2x32(doubleBits(floats.z)));
}

#endif
