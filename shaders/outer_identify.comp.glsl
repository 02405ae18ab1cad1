// Names the triangles behind the candidates: those whose depths the outer scopes hold there, a workgroup a band. The least
// (object, triangle) wins.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "interop.h"
#include "outer.glsl"

layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint kLanes = 32;

layout(scalar, binding = kBindPositions) readonly restrict buffer Positions { vec3 positions[]; };
layout(scalar, binding = kBindIndices) readonly restrict buffer Indices { uint indices[]; };
layout(scalar, binding = kBindViews) readonly restrict buffer Views { View views[]; };
layout(scalar, binding = kBindBands) readonly restrict buffer Bands { Band bands[]; };
layout(scalar, binding = kBindRanks) readonly restrict buffer Ranks { uint ranks[]; };
layout(scalar, binding = kBindAnswers) readonly restrict buffer Answers { Answer answers[]; };
layout(scalar, binding = kBindCandidates) restrict buffer Candidates { Candidate candidates[]; };

layout(push_constant) uniform Push { uint first; uint count; uint groupsX; uint plane; } push;

void nameAt(Band band, Facet f, float cellsPerPixel, uint name) {
  // Centres of pixels are never near a cell's edge.
  const uvec2 firstCell = uvec2((vec2(f.first) + 0.5) * cellsPerPixel);
  const uvec2 lastCell = uvec2((vec2(f.end) - 0.5) * cellsPerPixel);
  uvec2 cell = firstCell;
  while (cell.y <= lastCell.y) {
    // Cells are skipped until one has its candidate in the triangle: lavapipe runs both sides of an `if`, but leaves a loop.
    bool found = false;
    uint candidate = 0;
    vec2 centre = vec2(0.0);
    while (cell.y <= lastCell.y && !found) {
      const uint rank = ranks[kCells * band.view + kCellsPerSide * cell.y + cell.x];
      candidate = kCells * band.view + min(rank, kCells - 1);
      const uint packed = candidates[candidate].pixel;
      const uvec2 pixel = uvec2(packed & 0xffffu, packed >> 16);
      centre = vec2(pixel) + 0.5;
      found = rank != kNobody && all(greaterThanEqual(pixel, f.first)) && all(lessThan(pixel, f.end)) && covers(f, centre);
      ++cell.x;
      if (cell.x > lastCell.x) cell = uvec2(firstCell.x, cell.y + 1);
    }
    if (!found) return;
    const vec2 depths = depthsIn(f, centre, band.slack);
    if (band.isSensor != 0) {
      if (depths.y == candidates[candidate].mask) atomicMin(candidates[candidate].itemA, name);
    } else {
      if (depths.x == candidates[candidate].range) atomicMin(candidates[candidate].itemB, name);
    }
  }
}

void main() {
  const uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * push.groupsX;
  if (group >= push.count) return;
  const Band band = bands[push.first + group];
  if (answers[band.view].candidates == 0) return;
  const float cellsPerPixel = 1.0 / float(views[band.view].cell);
  const uvec2 firstPixel = uvec2(band.firstColumn, band.firstRow), endPixel = uvec2(band.endColumn, band.endRow);
  for (uint triangle = gl_LocalInvocationID.x; triangle < band.triangles; triangle += kLanes) {
    const uint corner = band.firstIndex + 3 * triangle;
    const vec3 p0 = inPixels(band, positions[band.firstVertex + indices[corner]]);
    const vec3 p1 = inPixels(band, positions[band.firstVertex + indices[corner + 1]]);
    const vec3 p2 = inPixels(band, positions[band.firstVertex + indices[corner + 2]]);
    // The same pixels as when it was drawn, and so the same bits.
    Facet f = facetOf(p0, p1, p2, band.snap, firstPixel, endPixel);
    f.first.y = max(f.first.y, band.fromRow);
    f.end.y = min(f.end.y, band.toRow);
    if (f.first.y < f.end.y) nameAt(band, f, cellsPerPixel, kItemTriangles * band.item + triangle);
  }
}
