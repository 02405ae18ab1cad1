// Draws outer scopes by pixel, the same bits as outer_draw.comp: a workgroup takes some rows of a view, and of these an
// invocation always the same pixels, so that nothing is atomic. For triangles of many pixels.
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
layout(scalar, binding = kBindStrips) readonly restrict buffer Strips { Strip strips[]; };
// kPixelGroup pixels at a time: a vector is loaded in the time of a number.
layout(scalar, binding = kBindScopes) restrict buffer Scopes { uvec4 scopes[]; };

layout(push_constant) uniform Push { uint first; uint count; uint groupsX; uint plane; } push;

// A group of pixels from `at`: what a triangle has there becomes part of what the scopes hold.
void keep(uint at, bvec4 covered, uvec4 nearest, uvec4 farthest) {
  const uint plane = push.plane / kPixelGroup;
  const uvec4 none = uvec4(kNobody);
  if (kDraws == kDrawFarthest) {
    const uint f = kScopeF * plane + at;
    scopes[f] = max(scopes[f], mix(uvec4(0), farthest, covered));
  } else if (kDraws == kDrawSensor) {
    const uint s = kScopeS * plane + at, m = kScopeM * plane + at;
    const uvec4 limit = scopes[kScopeF * plane + at];
    const bvec4 kept = bvec4(uvec4(covered) & uvec4(lessThanEqual(nearest, limit)));
    if (!any(kept)) return;
    scopes[s] = min(scopes[s], mix(none, nearest, kept));
    scopes[m] = max(scopes[m], mix(uvec4(0), farthest, kept));
  } else {
    const uint r = kScopeR * plane + at;
    const uvec4 limit = scopes[kScopeS * plane + at];
    const bvec4 kept = bvec4(uvec4(covered) & uvec4(greaterThanEqual(farthest, limit)));
    if (!any(kept)) return;
    scopes[r] = min(scopes[r], mix(none, nearest, kept));
  }
}

// Of the i-th pixel of the group that begins at `pixel`: whether the triangle may touch it, and the depths it may have there.
bool isIn(Facet f, uvec2 pixel, uint i) {
  const uint column = pixel.x + i;
  return column >= f.first.x && column < f.end.x && covers(f, vec2(column, pixel.y) + 0.5);
}

uvec2 keysAt(Facet f, uvec2 pixel, uint i, float slack) {
  const vec2 depths = depthsIn(f, vec2(pixel.x + i, pixel.y) + 0.5, slack);
  return uvec2(keyOf(depths.x), keyOf(depths.y));
}

// Of the rows of a strip this invocation has every so many; of a row see interop.h.
const uint kRowStep = kLanes / kGroupStep;

void drawRows(Band band, Facet f, uint fromRow, uint toRow) {
  const uvec2 mine = uvec2(gl_LocalInvocationID.x % kGroupStep, gl_LocalInvocationID.x / kGroupStep);
  // The first of its own that is not before the triangle's box.
  const uvec2 begin = uvec2(f.first.x / kPixelGroup, max(f.first.y, fromRow));
  const uvec2 step = uvec2(kGroupStep, kRowStep);
  const uvec2 first = begin + (mine + step - begin % step) % step;
  const uint endRow = min(f.end.y, toRow), endGroup = (f.end.x + kPixelGroup - 1) / kPixelGroup;
  uvec2 next = uvec2(first.x, first.x < endGroup ? first.y : endRow);
  while (next.y < endRow) {
    bvec4 covered = bvec4(false);
    uvec2 pixel = uvec2(0);
    // Groups are skipped until one counts: lavapipe runs both sides of an `if`, but leaves a loop.
    while (next.y < endRow && !any(covered)) {
      pixel = uvec2(kPixelGroup * next.x, next.y);
      covered = bvec4(isIn(f, pixel, 0), isIn(f, pixel, 1), isIn(f, pixel, 2), isIn(f, pixel, 3));
      next.x += kGroupStep;
      if (next.x >= endGroup) next = uvec2(first.x, next.y + kRowStep);
    }
    if (!any(covered)) return;
    const uvec2 a = keysAt(f, pixel, 0, band.slack), b = keysAt(f, pixel, 1, band.slack);
    const uvec2 c = keysAt(f, pixel, 2, band.slack), d = keysAt(f, pixel, 3, band.slack);
    keep((band.firstPixel + band.pitch * pixel.y + pixel.x) / kPixelGroup, covered, uvec4(a.x, b.x, c.x, d.x),
         uvec4(a.y, b.y, c.y, d.y));
  }
}

void main() {
  const uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * push.groupsX;
  if (group >= push.count) return;
  const Strip strip = strips[push.first + group];
  for (uint b = strip.firstBand; b < strip.endBand; ++b) {
    const uint firstRow = bands[b].firstRow, endRow = bands[b].endRow;
    if (endRow <= strip.firstRow || firstRow >= strip.endRow) continue;
    const Band band = bands[b];
    for (uint triangle = 0; triangle < band.triangles; ++triangle) {
      const uint corner = band.firstIndex + 3 * triangle;
      const vec3 p0 = inPixels(band, positions[band.firstVertex + indices[corner]]);
      const vec3 p1 = inPixels(band, positions[band.firstVertex + indices[corner + 1]]);
      const vec3 p2 = inPixels(band, positions[band.firstVertex + indices[corner + 2]]);
      const Facet f = facetOf(p0, p1, p2, band.snap, uvec2(band.firstColumn, band.firstRow),
                              uvec2(band.endColumn, band.endRow));
      drawRows(band, f, strip.firstRow, strip.endRow);
    }
  }
}
