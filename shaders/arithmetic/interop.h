// Structs of the checks of a device's arithmetic, shared with C++ (engine/gpu/arithmetic.cpp).
#ifndef RADAR_ARITHMETIC_INTEROP_H
#define RADAR_ARITHMETIC_INTEROP_H

#include "../shared/interop.h"

#ifdef __cplusplus
namespace radar::gpu {
#endif

INTEROP_CONST kTrials = 1024;
INTEROP_CONST kTrialGroup = 64;

// The operations checked. The shaders can falsify one of them, to show that the check finds it.
INTEROP_CONST kNoOperation = 0;
INTEROP_CONST kFloatSum = 1;
INTEROP_CONST kFloatProduct = 2;
INTEROP_CONST kFloatQuotient = 3;
INTEROP_CONST kFloatChain = 4;  // x * y + z under `precise`
INTEROP_CONST kFloatInverseRoot = 5;
INTEROP_CONST kFloatOrder = 6;
INTEROP_CONST kFloatOfInteger = 7;
INTEROP_CONST kFloatCopy = 8;
INTEROP_CONST kFloatSubnormal = 9;
INTEROP_CONST kFloatAdded = 10;  // addExactly() of two_floats.glsl
INTEROP_CONST kFloatDifference = 11;  // differenceInParts()
INTEROP_CONST kFloatParts = 12;  // partsOf() of shared/transform.glsl
INTEROP_CONST kFloatBox = 13;  // boxAround() of embed/box_around.glsl
INTEROP_CONST kDoubleSum = 14;
INTEROP_CONST kDoubleProduct = 15;
INTEROP_CONST kDoubleQuotient = 16;
INTEROP_CONST kDoubleCorrected = 17;  // correctedQuotient() of divide.glsl
INTEROP_CONST kDoublePlaced = 18;  // the formula of Transform
INTEROP_CONST kDoubleOrder = 19;
INTEROP_CONST kDoubleOfFloat = 20;
INTEROP_CONST kFloatOfDouble = 21;
INTEROP_CONST kDoubleCopy = 22;
INTEROP_CONST kDoubleRests = 23;  // what sums and products of double_double.glsl lose
INTEROP_CONST kDoubleSplit = 24;  // split() of widen.glsl
INTEROP_CONST kOperations = 25;

struct FloatTrial {
  float x, y, z;
  uint integer;  // below 2^24
  float copied;
  float low;        // small beside x
  uint bits[2];     // the bits of a double, low word first
};

struct FloatOutcome {
  float sum, product, quotient, chain, inverseRoot, ofInteger, copied;
  float addedHigh, addedLow;  // x + low + y + p - x, p an exact product of leading bits of x and z
  float apart, apartFirst;    // (x, low) - (y, z), and - (x, low) of the first trial
  uint high;                  // of `bits`: the leading ones, and what follows
  float rest;
  float centre, halfExtent;  // of the box from x to x + |x| / 10,000
  uint order;  // 1: x < y, 2: min(x, y) is x, 4: max(x, y) is x
};

struct DoubleTrial {
  double x, y;
  double row[4];
  Point p;
  uint pad;
};

struct DoubleOutcome {
  double sum, product, quotient, corrected, placed, ofFloat, copied;
  double rests[3];  // of x + y, of the larger plus the smaller, of x * y
  double chain[2];  // high and low of (x + x * y) * (x * y - y)
  float ofDouble;
  float high, low;  // x split
  uint order;  // as above
};

INTEROP_SLOT(kSlotFloatTrials, 0, FloatTrial);
INTEROP_SLOT(kSlotFloatOutcomes, 1, FloatOutcome);
INTEROP_SLOT(kSlotDoubleTrials, 0, DoubleTrial);
INTEROP_SLOT(kSlotDoubleOutcomes, 1, DoubleOutcome);

#ifdef __cplusplus
}  // namespace radar::gpu
#endif
#endif
