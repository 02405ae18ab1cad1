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
INTEROP_CONST kDoubleSum = 10;
INTEROP_CONST kDoubleProduct = 11;
INTEROP_CONST kDoubleQuotient = 12;
INTEROP_CONST kDoubleCorrected = 13;  // correctedQuotient() of divide.glsl
INTEROP_CONST kDoublePlaced = 14;     // the formula of Transform
INTEROP_CONST kDoubleOrder = 15;
INTEROP_CONST kDoubleOfFloat = 16;
INTEROP_CONST kFloatOfDouble = 17;
INTEROP_CONST kDoubleCopy = 18;
INTEROP_CONST kOperations = 19;

struct FloatTrial {
  float x, y, z;
  uint integer;  // below 2^24
  float copied;
};

struct FloatOutcome {
  float sum, product, quotient, chain, inverseRoot, ofInteger, copied;
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
  float ofDouble;
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
