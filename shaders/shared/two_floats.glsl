// Numbers of two floats, high + low. Where the order of operations carries the precision, they are `precise`; so is the last
// one, since optimisers may reorder a sum that is not, with all sums that it is made of.
#ifndef RADAR_TWO_FLOATS_GLSL
#define RADAR_TWO_FLOATS_GLSL

// 2^-24, half an ulp of 1. An operation may be off by twice that, since Vulkan fixes no rounding direction for floats.
const float kUnit = 5.9604645e-8;

float sum3(vec3 v) { return v.x + v.y + v.z; }

// Adds q to high + low. To nearest, only the sum of the low parts is rounded; in other directions, the rest may be off, too, by
// up to 2^-45 of the sum: docs/method.md allows 2^-40.
void addExactly(inout float high, inout float low, float q) {
  precise float s = high + q;
  precise float part = s - high;
  precise float rest = (high - (s - part)) + (q - part);
  precise float more = low + rest;
  high = s;
  low = more;
}

// Adds p q to high + low, as the four products of their halves, which are exact unless they flush to 0.
void addProduct(inout float high, inout float low, float p, float q) {
  const float p1 = uintBitsToFloat(floatBitsToUint(p) & 0xfffff000u), q1 = uintBitsToFloat(floatBitsToUint(q) & 0xfffff000u);
  precise float p2 = p - p1, q2 = q - q1;
  precise float leading = p1 * q1, first = p1 * q2, second = p2 * q1, last = p2 * q2;
  addExactly(high, low, leading);
  addExactly(high, low, first);
  addExactly(high, low, second);
  addExactly(high, low, last);
}

// The difference of two such numbers.
float differenceInParts(float high, float low, float otherHigh, float otherLow) {
  precise float sum = (high - otherHigh) + (low - otherLow);
  return sum;
}
vec3 differenceInParts(vec3 high, vec3 low, vec3 otherHigh, vec3 otherLow) {
  precise vec3 sum = (high - otherHigh) + (low - otherLow);
  return sum;
}

#endif
