// Draws outer scopes by triangle: a workgroup takes a band, an invocation some of its triangles. A pixel that a triangle
// may touch keeps the extreme of the depths it may have there. outer_fill.comp draws the same by pixel.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "interop.h"
#include "outer.glsl"

layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint kLanes = 32;
layout(constant_id = 1) const uint kDraws = kDrawFarthest;

layout(scalar, binding = kBindPositions) readonly restrict buffer Positions { vec3 positions[]; };
layout(scalar, binding = kBindIndices) readonly restrict buffer Indices { uint indices[]; };
layout(scalar, binding = kBindBands) readonly restrict buffer Bands { Band bands[]; };
layout(scalar, binding = kBindScopes) restrict buffer Scopes { uint scopes[]; };

layout(push_constant) uniform Push { uint first; uint count; uint groupsX; uint plane; } push;

// A read first: on most pixels nothing changes, and atomics cost more.
void lower(uint at, uint key) {
  if (key < scopes[at]) atomicMin(scopes[at], key);
}

void raise(uint at, uint key) {
  if (key > scopes[at]) atomicMax(scopes[at], key);
}

void keep(uint at, vec2 depths) {
  const uint nearest = keyOf(depths.x), farthest = keyOf(depths.y);
  if (kDraws == kDrawFarthest) {
    raise(kScopeF * push.plane + at, farthest);
  } else if (kDraws == kDrawSensor) {
    if (nearest > scopes[kScopeF * push.plane + at]) return;
    lower(kScopeS * push.plane + at, nearest);
    raise(kScopeM * push.plane + at, farthest);
  } else {
    if (farthest < scopes[kScopeS * push.plane + at]) return;
    lower(kScopeR * push.plane + at, nearest);
  }
}

// Nothing of the other side is there: nothing to keep.
bool idle(uint at) {
  if (kDraws == kDrawSensor) return scopes[kScopeF * push.plane + at] == 0;
  if (kDraws == kDrawNearest) return scopes[kScopeS * push.plane + at] == kNobody;
  return false;
}

void main() {
  const uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * push.groupsX;
  if (group >= push.count) return;
  const Band band = bands[push.first + group];
  const uvec2 firstPixel = uvec2(band.firstColumn, band.firstRow), endPixel = uvec2(band.endColumn, band.endRow);
  for (uint triangle = gl_LocalInvocationID.x; triangle < band.triangles; triangle += kLanes) {
    const uint corner = band.firstIndex + 3 * triangle;
    const vec3 p0 = inPixels(band, positions[band.firstVertex + indices[corner]]);
    const vec3 p1 = inPixels(band, positions[band.firstVertex + indices[corner + 1]]);
    const vec3 p2 = inPixels(band, positions[band.firstVertex + indices[corner + 2]]);
    const Facet f = facetOf(p0, p1, p2, band.snap, firstPixel, endPixel);
    const uint endRow = min(f.end.y, band.toRow);
    uvec2 next = uvec2(f.first.x, max(f.first.y, band.fromRow));
    while (next.y < endRow) {
      // Pixels are skipped until one counts: lavapipe runs both sides of an `if`, but leaves a loop.
      bool found = false;
      uint at = 0;
      vec2 centre = vec2(0.0);
      while (next.y < endRow && !found) {
        at = band.firstPixel + band.pitch * next.y + next.x;
        centre = vec2(next) + 0.5;
        found = covers(f, centre) && !idle(at);
        ++next.x;
        if (next.x == f.end.x) next = uvec2(f.first.x, next.y + 1);
      }
      if (found) keep(at, depthsIn(f, centre, band.slack));
    }
  }
}
