// Identifies the triangles of the candidates. A workgroup takes kItemTriangles triangles of one draw; an invocation tests
// which candidates' pixel centres each of its triangles covers at the depth that the scope stores there. The least (object,
// triangle) wins. Coverage is tested `snap` wider than exact, since fixed-function rasterisation snaps vertices. A pixel
// only proposes a pair, so identifying a neighbour instead costs accuracy, not correctness.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#define RADAR_NO_DOUBLES
#include "interop.h"
#include "shared/scene.glsl"
#include "shared/workgroup.glsl"

layout(local_size_x = kItemInvocations) in;

layout(scalar, binding = kSlotMeshes) readonly restrict buffer Meshes { MeshRecord meshes[]; };
layout(scalar, binding = kSlotViews) readonly restrict buffer Views { View views[]; };
layout(scalar, binding = kSlotDraws) readonly restrict buffer Draws { Draw draws[]; };
layout(scalar, binding = kSlotItems) readonly restrict buffer Items { Item items[]; };
layout(scalar, binding = kSlotRanks) readonly restrict buffer Ranks { uint ranks[]; };
layout(scalar, binding = kSlotAnswers) readonly restrict buffer Answers { Answer answers[]; };
layout(scalar, binding = kSlotCandidates) restrict buffer Candidates { Candidate candidates[]; };

layout(push_constant) uniform PushConstants { IdentifyPush push; };

// The pixel centre that a cell proposes, or one outside every window.
vec2 centreOf(uint v, uvec2 cell, out uint candidate) {
  const uint rank = ranks[kCells * v + kCellsPerSide * cell.y + cell.x];
  candidate = kCells * v + min(rank, kCells - 1);
  const uint pixel = candidates[candidate].pixel;
  return rank == kNobody ? vec2(-1e9) : vec2(pixel & 0xffffu, pixel >> 16) + 0.5;
}

// How far `centre` lies inside an edge, as area; negative outside. Widened by `snap` and by rounding.
float insideBy(vec2 from, vec2 to, vec2 centre, float turn, float snap) {
  const vec2 edge = to - from, offset = centre - from;
  const float a = edge.x * offset.y, b = edge.y * offset.x;
  return turn * (a - b) + (abs(edge.x) + abs(edge.y)) * snap + 9.5367431640625e-7 * (abs(a) + abs(b));
}

// The values that all triangles of a draw share.
struct Surface {
  uint view;
  bool isSensor;
  float snap, slack, cellSide;
  vec2 window;
};

// Offers the triangle (pixels across, stored depth along) to the candidates that it covers.
void nameAt(Surface s, vec3 p0, vec3 p1, vec3 p2, uint name) {
  const vec3 low = min(min(p0, p1), p2), high = max(max(p0, p1), p2);
  const vec2 lowEdge = low.xy - s.snap, highEdge = high.xy + s.snap;
  if (any(greaterThan(lowEdge, s.window)) || any(lessThan(highEdge, vec2(0.0))) || low.z > 1.0 || high.z < 0.0) return;

  const vec2 a = p1.xy - p0.xy, b = p2.xy - p0.xy;
  const vec2 rise = vec2(p1.z - p0.z, p2.z - p0.z);
  const float area = a.x * b.y - a.y * b.x;
  const float turn = area < 0.0 ? -1.0 : 1.0;
  // The gradient of a sliver is all rounding error, or overflows; the vertices' depth range is used instead.
  const bool sliver = abs(area) <= 0.0009765625 * (abs(a.x * b.y) + abs(a.y * b.x)) ||
                      abs(area) <= 1.52587890625e-5 * max(max(abs(a.x), abs(a.y)), max(abs(b.x), abs(b.y)));
  const vec2 slope = vec2(rise.x * b.y - rise.y * a.y, rise.y * a.x - rise.x * b.x);
  const vec2 gradient = sliver ? vec2(0.0) : slope / (sliver ? 1.0 : area);
  const float slack = s.slack + (abs(gradient.x) + abs(gradient.y)) * s.snap;

  // Most triangles cover no candidate. The inner loop skips cells until one has its candidate in the triangle's box: a
  // loop, because lavapipe leaves a loop early but runs both sides of an `if`.
  const vec2 lastOfAll = vec2(kCellsPerSide - 1);
  const uvec2 firstCell = uvec2(clamp(lowEdge / s.cellSide, vec2(0.0), lastOfAll));
  const uvec2 lastCell = uvec2(clamp(highEdge / s.cellSide, vec2(0.0), lastOfAll));
  const uint columns = lastCell.x - firstCell.x + 1, cells = columns * (lastCell.y - firstCell.y + 1);
  uint next = 0;
  while (true) {
    vec2 centre;
    uint c;
    bool found = false;
    while (next < cells && !found) {
      centre = centreOf(s.view, firstCell + uvec2(next % columns, next / columns), c);
      found = all(greaterThanEqual(centre, lowEdge)) && all(lessThanEqual(centre, highEdge));
      ++next;
    }
    if (!found) break;
    const float inside = min(min(insideBy(p0.xy, p1.xy, centre, turn, s.snap), insideBy(p1.xy, p2.xy, centre, turn, s.snap)),
                             insideBy(p2.xy, p0.xy, centre, turn, s.snap));
    const float stored = s.isSensor ? candidates[c].mask : candidates[c].range;
    const float depth = p0.z + dot(gradient, centre - p0.xy);
    const float lowest = sliver ? low.z : max(depth, low.z), highest = sliver ? high.z : min(depth, high.z);
    if (inside < 0.0 || stored < lowest - slack || stored > highest + slack) continue;
    if (s.isSensor) {
      atomicMin(candidates[c].itemA, name);
    } else {
      atomicMin(candidates[c].itemB, name);
    }
  }
}

void main() {
  const uint item = workgroupIndex();
  if (item >= push.items) return;
  const Item work = items[item];
  const Draw draw = draws[work.draw];
  const uint v = draw.view;
  if (answers[v].candidates == 0) return;

  const mat4x3 clipFromMesh = mat4x3(
      draw.clipFromMesh[0], draw.clipFromMesh[4], draw.clipFromMesh[8], draw.clipFromMesh[1], draw.clipFromMesh[5],
      draw.clipFromMesh[9], draw.clipFromMesh[2], draw.clipFromMesh[6], draw.clipFromMesh[10], draw.clipFromMesh[3],
      draw.clipFromMesh[7], draw.clipFromMesh[11]);
  const float halfWidth = 0.5 * float(views[v].resolution);
  const vec3 scale = vec3(halfWidth, halfWidth, 1.0), shift = vec3(halfWidth, halfWidth, 0.0);
  Surface surface;
  surface.view = v;
  surface.isSensor = draw.object == kNobody;
  surface.snap = draw.snap;
  surface.slack = draw.slack;
  surface.cellSide = float(views[v].cell);
  surface.window = vec2(views[v].width, views[v].height);
  const MeshRecord mesh = meshes[draw.mesh];
  for (uint triangle = work.firstTriangle + gl_LocalInvocationID.x; triangle < work.endTriangle;
       triangle += kItemInvocations) {
    const uvec4 corner = triangleAt(mesh.firstTriangle + triangle);
    // Pixels across, stored depth along.
    const vec3 p0 = clipFromMesh * vec4(vertexAt(corner.x) - mesh.origin, 1.0) * scale + shift;
    const vec3 p1 = clipFromMesh * vec4(vertexAt(corner.y) - mesh.origin, 1.0) * scale + shift;
    const vec3 p2 = clipFromMesh * vec4(vertexAt(corner.z) - mesh.origin, 1.0) * scale + shift;
    nameAt(surface, p0, p1, p2, kItemTriangles * item + triangle - work.firstTriangle);
  }
}
