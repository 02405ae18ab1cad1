// The lower bound of all sensors in one dispatch: a workgroup per sensor, an invocation per cell. Each cell nominates its
// pixel of the least bound; the candidates are written in the order of (bound, pixel).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "interop.h"
#include "outer.glsl"

layout(local_size_x = kCells) in;

layout(scalar, binding = kBindViews) readonly restrict buffer Views { View views[]; };
layout(scalar, binding = kBindScopes) readonly restrict buffer Scopes { uint scopes[]; };
layout(scalar, binding = kBindCandidates) writeonly restrict buffer Candidates { Candidate candidates[]; };
layout(scalar, binding = kBindRanks) writeonly restrict buffer Ranks { uint ranks[]; };
layout(scalar, binding = kBindAnswers) writeonly restrict buffer Answers { Answer answers[]; };

layout(push_constant) uniform Push { uint first; uint count; uint groupsX; uint plane; } push;

const float kFar = 3.0e38;

shared float listBound[kCells];
shared uint listPixel[kCells];
shared uint listCount;
shared uint least;

void main() {
  const uint v = gl_WorkGroupID.x;
  const uint cell = gl_LocalInvocationID.x;
  const uint width = views[v].width, pitch = (width + kPixelGroup - 1) / kPixelGroup * kPixelGroup;
  const uint side = views[v].cell, firstPixel = views[v].firstPixel;
  const uvec2 first = side * uvec2(cell % kCellsPerSide, cell / kCellsPerSide);
  const uvec2 end = min(first + side, uvec2(width, views[v].height));
  if (cell == 0) {
    listCount = 0;
    least = floatBitsToUint(kFar);
  }
  barrier();
  float best = kFar;
  uint bestPixel = 0, bestAt = 0;
  uvec2 pixel = first;
  const bool some = all(lessThan(first, end));
  while (some && pixel.y < end.y) {
    const uint at = firstPixel + pitch * pixel.y + pixel.x;
    const uint range = scopes[kScopeR * push.plane + at], mask = scopes[kScopeM * push.plane + at];
    // Where either is missing, no pair of triangles can meet; the difference rounds by u.
    const float bound = max((depthOf(range) - depthOf(mask)) * (1.0 - 4.0 * kUnit), 0.0);
    if (range != kNobody && mask != 0 && bound < best) {
      best = bound;
      bestPixel = pixel.y << 16 | pixel.x;
      bestAt = at;
    }
    ++pixel.x;
    if (pixel.x == end.x) pixel = uvec2(first.x, pixel.y + 1);
  }
  if (best < kFar) atomicMin(least, floatBitsToUint(best));
  const bool nominates = best <= views[v].rangeLimit;
  if (nominates) {
    const uint place = atomicAdd(listCount, 1);
    listBound[place] = best;
    listPixel[place] = bestPixel;
  }
  barrier();

  const uint others = nominates ? listCount : 0;  // lavapipe leaves a loop that no lane is in
  uint rank = 0;
  for (uint i = 0; i < others; ++i) {
    rank += uint(listBound[i] < best || (listBound[i] == best && listPixel[i] < bestPixel));
  }
  ranks[kCells * v + cell] = nominates ? rank : kNobody;
  if (nominates) {
    const float range = depthOf(scopes[kScopeR * push.plane + bestAt]);
    const float mask = depthOf(scopes[kScopeM * push.plane + bestAt]);
    candidates[kCells * v + rank] = Candidate(bestPixel, range, mask, kNobody, kNobody);
  }
  if (cell == 0) {
    const float lo = uintBitsToFloat(least);
    answers[v] =
        Answer(double(0), kNobody, kNobody, kNobody, kNobody, 0.0, 0, listCount, 0, 0, lo < kFar ? lo : -1.0);
  }
}
