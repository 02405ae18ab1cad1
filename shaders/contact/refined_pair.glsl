// What certify.comp, refine.comp, prove.comp and block.comp share: a lane judges one refined pair, and may lower its sensor's
// upper bound.
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
#include "interop.h"
#include "shared/scene.glsl"
#include "shared/bounded.glsl"
#include "placed_corners.glsl"
#include "shared/workgroup.glsl"

layout(local_size_x = kContactGroup) in;

layout(scalar, binding = kSlotStates) restrict buffer States { SearchState states[]; };
layout(scalar, binding = kSlotCounts) restrict buffer Counts { SearchCounts counts; };
layout(scalar, binding = kSlotRefinedPairs) restrict buffer RefinedPairs { RefinedPair refinedPairs[]; };
layout(scalar, binding = kSlotSweeps) readonly restrict buffer Sweeps { Sweep sweeps[]; };
layout(scalar, binding = kSlotObjects) readonly restrict buffer Objects { ObjectRecord objects[]; };

// Bounds of pairs in doubles as floats: lowers a sensor's upper bound of first contact to that of a pair.

// Lower bounds are lowered and upper bounds raised by kRounded, relative to their value: products may round them inwards. By this
// as floats.
const double kRoundedFloat = 2.4e-7LF;

// A lower bound, scaled, rounded down.
float scaledDown(double low, Sweep sweep) {
  return float(min(low * double(sweep.scale), 1e38LF) * (1.0LF - kRoundedFloat));
}

// `by`: the pair certainly meets by this multiple of the direction.
double scaledHi(Sweep sweep, double by) { return max(by, 0.0LF) * sweep.directionLength * double(sweep.scale); }

bool wouldLowerHi(uint search, Sweep sweep, double by) {
  return scaledHi(sweep, by) < double(uintBitsToFloat(states[search].hi));
}

void lowerHi(uint search, Sweep sweep, double by) {
  if (!wouldLowerHi(search, sweep, by)) return;
  atomicMin(states[search].hi, floatBitsToUint(float(scaledHi(sweep, by) * (1.0LF + kRoundedFloat)) + 1e-37));
}
