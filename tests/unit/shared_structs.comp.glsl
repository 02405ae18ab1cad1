// Every struct that C++ and GLSL share, as the element of a buffer, so that each has a layout: some are otherwise only
// read as texels or pushed.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "shaders/arithmetic/interop.h"
#include "shaders/contact/interop.h"
#include "shaders/embed/interop.h"
#include "shaders/sampled/interop.h"

layout(scalar, binding = 0) readonly buffer B0 { MeshNode b0[]; };
layout(scalar, binding = 1) readonly buffer B1 { ObjectNode b1[]; };
layout(scalar, binding = 2) readonly buffer B2 { Vertex b2[]; };
layout(scalar, binding = 3) readonly buffer B3 { Triangle b3[]; };
layout(scalar, binding = 4) readonly buffer B4 { Placement b4[]; };
layout(scalar, binding = 5) readonly buffer B5 { MeshRecord b5[]; };
layout(scalar, binding = 6) readonly buffer B6 { ObjectRecord b6[]; };
layout(scalar, binding = 7) readonly buffer B7 { View b7[]; };
layout(scalar, binding = 8) readonly buffer B8 { Draw b8[]; };
layout(scalar, binding = 9) readonly buffer B9 { Item b9[]; };
layout(scalar, binding = 10) readonly buffer B10 { Candidate b10[]; };
layout(scalar, binding = 11) readonly buffer B11 { Answer b11[]; };
layout(scalar, binding = 12) readonly buffer B12 { SampledUnresolved b12[]; };
layout(scalar, binding = 13) readonly buffer B13 { BoundsViolation b13[]; };
layout(scalar, binding = 14) readonly buffer B14 { Moved b14[]; };
layout(scalar, binding = 15) readonly buffer B15 { Sensor b15[]; };
layout(scalar, binding = 16) readonly buffer B16 { Sweep b16[]; };
layout(scalar, binding = 17) readonly buffer B17 { SearchState b17[]; };
layout(scalar, binding = 18) readonly buffer B18 { SearchTask b18[]; };
layout(scalar, binding = 19) readonly buffer B19 { CandidatePair b19[]; };
layout(scalar, binding = 20) readonly buffer B20 { RefinedPair b20[]; };
layout(scalar, binding = 21) readonly buffer B21 { UnresolvedPair b21[]; };
layout(scalar, binding = 22) readonly buffer B22 { SearchRound b22[]; };
layout(scalar, binding = 23) readonly buffer B23 { SearchCounts b23[]; };
layout(scalar, binding = 24) readonly buffer B24 { SearchPush b24[]; };
layout(scalar, binding = 25) readonly buffer B25 { CollectPush b25[]; };
layout(scalar, binding = 26) readonly buffer B26 { FilterPush b26[]; };
layout(scalar, binding = 27) readonly buffer B27 { ResolvePush b27[]; };
layout(scalar, binding = 28) readonly buffer B28 { FloatTrial b28[]; };
layout(scalar, binding = 29) readonly buffer B29 { FloatOutcome b29[]; };
#ifndef RADAR_NO_DOUBLES
layout(scalar, binding = 30) readonly buffer B30 { DoubleTrial b30[]; };
layout(scalar, binding = 31) readonly buffer B31 { DoubleOutcome b31[]; };
#endif
layout(scalar, binding = 32) readonly buffer B32 { IdentifyPush b32[]; };
layout(scalar, binding = 33) readonly buffer B33 { DeformPush b33[]; };
layout(scalar, binding = 34) readonly buffer B34 { RefitPush b34[]; };
layout(scalar, binding = 35) readonly buffer B35 { MovePush b35[]; };
layout(scalar, binding = 36) readonly buffer B36 { InvalidatePush b36[]; };
layout(scalar, binding = 39) readonly buffer B39 { Gathered b39[]; };
layout(scalar, binding = 40) readonly buffer B40 { GatherPush b40[]; };
layout(scalar, binding = 41) readonly buffer B41 { FitPush b41[]; };
layout(scalar, binding = 42) readonly buffer B42 { ReachPush b42[]; };
layout(scalar, binding = 43) readonly buffer B43 { Extent b43[]; };
layout(scalar, binding = 44) readonly buffer B44 { DeformedSensor b44[]; };
layout(scalar, binding = 45) readonly buffer B45 { BoundPush b45[]; };
layout(scalar, binding = 46) readonly buffer B46 { NormalisePush b46[]; };
layout(scalar, binding = 47) readonly buffer B47 { PlacePush b47[]; };
layout(scalar, binding = 37) readonly buffer B37 { TransformLayout b37[]; };
layout(scalar, binding = 38) readonly buffer B38 { PlanPush b38[]; };

layout(local_size_x = 1) in;

void main() {}
