// The layout of a radar::Recorder's results in shaders: the bytes of radar::Result. radar/query.h explains the members.
// Absent numbers are infinite or NaN, absent ids RADAR_NONE.
//
//     #extension GL_EXT_scalar_block_layout : require
//     #extension GL_GOOGLE_include_directive : require
//     #include "radar/result.glsl"
//     layout(scalar, binding = 0) readonly buffer Results { RadarResult results[]; };
//
// In a shader without doubles, define RADAR_NO_DOUBLES first: doubles are then given as their bits, for radarFloat().
// RADAR_RESULT_BITS does the same to preserve NaN, which a device may lose in double operations.
#ifndef RADAR_RESULT_GLSL
#define RADAR_RESULT_GLSL

#if defined(RADAR_NO_DOUBLES) || defined(RADAR_RESULT_BITS)
#define RADAR_DOUBLE uvec2
#else
#define RADAR_DOUBLE double
#endif

struct RadarResult {
  uint status;      // RADAR_HIT ...
  uint tier;        // RADAR_TIER_*
  uint detected;    // RADAR_NOT_DETECTED ...
  uint resolution;  // pixels
  RADAR_DOUBLE t;
  RADAR_DOUBLE lo;
  RADAR_DOUBLE hi;
  RADAR_DOUBLE fraction;
  uint object;
  uint triB;
  uint triA;
  uint flags;       // RADAR_UNRESOLVED ...: why there is no answer; else 0
  uint featureB;    // RADAR_VERTEX ...
  uint featureA;
  RADAR_DOUBLE point[3];
  RADAR_DOUBLE normal[3];
  RADAR_DOUBLE paperMinL;
};

const uint RADAR_HIT = 0;
const uint RADAR_CLEAR = 1;
const uint RADAR_OVERLAP = 2;
const uint RADAR_UNDECIDED = 3;
const uint RADAR_INVALID = 4;

const uint RADAR_TIER_SELECT = 0;
const uint RADAR_TIER_CONTACT = 2;

const uint RADAR_NOT_DETECTED = 0;
const uint RADAR_DETECTED = 1;
const uint RADAR_NOT_LOOKED = 2;

const uint RADAR_NONE = 0xffffffffu;

const uint RADAR_NO_FEATURE = 0;
const uint RADAR_VERTEX = 1;
const uint RADAR_EDGE = 2;
const uint RADAR_FACE = 3;

const uint RADAR_UNRESOLVED = 1;
const uint RADAR_TOO_MANY_CANDIDATES = 2;
const uint RADAR_TOO_LONG = 4;
const uint RADAR_OUT_OF_RANGE = 8;
const uint RADAR_OUT_OF_BOUNDS = 16;
const uint RADAR_BAD_QUERY = 32;

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

#endif
