// The layout of a radar::Recorder's results in shaders: the bytes of radar::Result. radar/answers.h explains the members.
// Absent numbers are infinite or NaN, absent ids RADAR_NONE. The point of an overlap is absent: only read() finds it.
//
//     #extension GL_EXT_scalar_block_layout : require
//     #extension GL_GOOGLE_include_directive : require
//     #include "radar/result.glsl"
//     layout(scalar, binding = 0) readonly buffer Results { RadarResult results[]; };
//
// In a shader without doubles, define RADAR_NO_DOUBLES first: doubles are then given as their bits, for radarFloat().
// RADAR_RESULT_BITS does the same to preserve NaN, which a device may lose in double operations.
//
// Who moves by all of radarFree() may touch: stop short, by more than the rounding of the place that results.
#ifndef RADAR_RESULT_GLSL
#define RADAR_RESULT_GLSL

#include "radar/codes.h"

#if defined(RADAR_NO_DOUBLES) || defined(RADAR_RESULT_BITS)
#define RADAR_DOUBLE uvec2
#else
#define RADAR_DOUBLE double
#endif

struct RadarResult {
  uint status;      // RADAR_STATUS_*
  uint tier;        // RADAR_TIER_*
  uint detected;    // RADAR_DETECTED_*
  uint resolution;  // pixels
  RADAR_DOUBLE t;
  RADAR_DOUBLE lo;
  RADAR_DOUBLE hi;
  RADAR_DOUBLE fraction;
  uint object;
  uint triB;
  uint triA;
  uint flags;       // RADAR_FLAG_*: why there is no answer; else 0
  uint featureB;    // RADAR_FEATURE_*
  uint featureA;
  RADAR_DOUBLE point[3];
  RADAR_DOUBLE normal[3];
  RADAR_DOUBLE gap;
  RADAR_DOUBLE paperMinL;
};

const uint RADAR_NONE = 0xffffffffu;

// Rounds a double, given as its bits, low word first, to float, towards 0.
float radarFloat(uvec2 bits) {
  const uint exponent = bits.y >> 20 & 0x7ffu;
  const uint sign = bits.y & 0x80000000u;
  const uint significand = (bits.y & 0xfffffu) << 3 | bits.x >> 29;
  if (exponent == 0x7ffu) return uintBitsToFloat(sign | 0x7f800000u | significand | (bits.x != 0 ? 1u : 0u));
  if (exponent > 1150u) return uintBitsToFloat(sign | 0x7f7fffffu);
  if (exponent < 897u) return uintBitsToFloat(sign);
  return uintBitsToFloat(sign | (exponent - 896u) << 23 | significand);
}
#if !defined(RADAR_NO_DOUBLES) && !defined(RADAR_RESULT_BITS)
float radarFloat(double value) {
  return radarFloat(unpackDouble2x32(value));
}
#endif

// How far the sensor may move of the distance `asked`, which is not above the query's, before it can touch anything: also
// where the device could not decide where exactly that is. 0 if there is no answer.
float radarFree(RadarResult result, float asked) {
  return result.status == RADAR_STATUS_invalid ? 0.0 : min(radarFloat(result.lo), asked);
}

#endif
