// Computes L = R + M - d and its minimum for all sensors in one dispatch: one workgroup per sensor, one invocation per
// cell. Each cell proposes its least L that may be a contact. The candidates are written in order of (L, pixel).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "interop.h"
#include "shared/float_order.glsl"

layout(local_size_x = kCells) in;

layout(scalar, binding = kSlotViews) readonly restrict buffer Views { View views[]; };
layout(scalar, binding = kSlotCandidates) writeonly restrict buffer Candidates { Candidate candidates[]; };
layout(scalar, binding = kSlotRanks) writeonly restrict buffer Ranks { uint ranks[]; };
layout(scalar, binding = kSlotAnswers) writeonly restrict buffer Answers { Answer answers[]; };
layout(scalar, binding = kSlotStates) writeonly restrict buffer States { SearchState states[]; };
layout(binding = kSlotRange) uniform sampler2DArray rangeScope;
layout(binding = kSlotMask) uniform sampler2DArray maskScope;

const float kFar = 3.0e38;

// The candidates, not yet sorted. Pixels are y << 16 | x here, which orders them row by row.
shared float listL[kCells];
shared uint listPixel[kCells];
shared uint listCount;
shared uint minLOrdered;
shared uint detectedAny;

// What a cell finds: its least L, and of its pixels that may be a contact the one of the least L; of equals, the first.
struct Cell {
  bool detected;
  float minL, bestL, bestRange, bestMask;
  uint bestPixel;
};

Cell readCell(View view, uint cell) {
  const uvec2 first = view.cell * uvec2(cell % kCellsPerSide, cell / kCellsPerSide);
  const uvec2 end = min(first + view.cell, uvec2(view.width, view.height));
  const vec2 texel = 1.0 / vec2(textureSize(rangeScope, 0).xy);

  // Quads of texels are read whole and without branches. A texel outside the window, with an empty R or without the sensor
  // counts as infinitely far. (u, v4) is a texel's place in its quad, in the order of textureGather.
  const uvec4 u = uvec4(0, 1, 1, 0), v4 = uvec4(1, 1, 0, 0);
  uvec4 detected4 = uvec4(0);
  vec4 minL4 = vec4(kFar), bestL4 = vec4(kFar), bestRange4 = vec4(1.0), bestMask4 = vec4(1.0);
  uvec4 bestPixel4 = uvec4(kNobody);
  for (uint y = first.y; y < end.y; y += 2) {
    const uvec4 row = y + v4;
    for (uint x = first.x; x < end.x; x += 2) {
      const vec3 corner = vec3(vec2(x + 1, y + 1) * texel, view.layer);
      const vec4 range = textureGather(rangeScope, corner);
      const vec4 mask = textureGather(maskScope, corner);
      const uvec4 column = x + u;
      const uvec4 seen = uvec4(lessThan(column, end.xxxx)) & uvec4(lessThan(row, end.yyyy)) & uvec4(lessThan(range, vec4(1.0)));
      const uvec4 both = seen & uvec4(lessThan(mask, vec4(1.0)));
      detected4 |= seen & uvec4(lessThanEqual(range, vec4(view.rangeLimit)));
      const vec4 L = mix(vec4(kFar), view.rangeScale * range - (view.maskBase - view.maskScale * mask), bvec4(both));
      minL4 = min(minL4, L);
      // Rows and columns ascend, so the earlier pixel wins at equal L.
      const bvec4 better = bvec4(uvec4(greaterThanEqual(L, vec4(-view.slack))) & uvec4(lessThan(L, bestL4)));
      bestL4 = mix(bestL4, L, better);
      bestPixel4 = mix(bestPixel4, row << 16 | column, better);
      bestRange4 = mix(bestRange4, range, better);
      bestMask4 = mix(bestMask4, mask, better);
    }
  }
  Cell found = Cell(detected4 != uvec4(0), min(min(minL4.x, minL4.y), min(minL4.z, minL4.w)), kFar, 1.0, 1.0, kNobody);
  for (uint k = 0; k < 4; ++k) {
    if (bestL4[k] > found.bestL || (bestL4[k] == found.bestL && bestPixel4[k] >= found.bestPixel)) continue;
    found.bestL = bestL4[k];
    found.bestPixel = bestPixel4[k];
    found.bestRange = bestRange4[k];
    found.bestMask = bestMask4[k];
  }
  return found;
}

void main() {
  const uint v = gl_WorkGroupID.x;
  const uint cell = gl_LocalInvocationID.x;
  if (cell == 0) {
    listCount = 0;
    minLOrdered = inOrder(floatBitsToUint(kFar));
    detectedAny = 0;
  }
  barrier();
  const Cell own = readCell(views[v], cell);
  const bool proposes = own.bestPixel != kNobody;
  if (own.detected) {
    atomicOr(detectedAny, 1);
    atomicMin(minLOrdered, inOrder(floatBitsToUint(own.minL)));
  }
  if (proposes) {
    const uint place = atomicAdd(listCount, 1);
    listL[place] = own.bestL;
    listPixel[place] = own.bestPixel;
  }
  barrier();

  const uint count = listCount;
  uint rank = 0;
  for (uint i = 0; i < count; ++i) {
    rank += uint(listL[i] < own.bestL || (listL[i] == own.bestL && listPixel[i] < own.bestPixel));
  }
  ranks[kCells * v + cell] = proposes ? rank : kNobody;
  if (proposes) {
    candidates[kCells * v + rank] = Candidate(own.bestPixel, own.bestRange, own.bestMask, kNobody, kNobody);
  }
  if (cell == 0) {
    const float least = floatOf(minLOrdered);
    const uint flags = (detectedAny != 0 ? kAnswerDetected : 0) | (least < kFar ? kAnswerHasL : 0);
    answers[v] = Answer(least, flags, count);
    states[v] = SearchState(floatBitsToUint(views[v].start), 0, kNobody);
  }
}
