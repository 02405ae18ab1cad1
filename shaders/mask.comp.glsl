// The mask: outer scopes (outer.glsl) of what a search for first contact has left, and which triangles may still be first.
// A workgroup takes a cluster, an invocation some of its triangles. Where a triangle can meet something of the other side
// within what is known to be touched, at some pixel, it is alive in that pixel's tile; the cluster's box is then that of
// its alive triangles.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "interop.h"
#include "outer.glsl"

layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint kLanes = 32;
layout(constant_id = 1) const uint kDraws = kMaskFarthest;

layout(scalar, binding = kBindPositions) readonly restrict buffer Positions { vec3 positions[]; };
layout(scalar, binding = kBindIndices) readonly restrict buffer Indices { uvec3 triangles[]; };
layout(scalar, binding = kBindMeshes) readonly restrict buffer Meshes { MeshRecord meshes[]; };
layout(scalar, binding = kBindNodes) readonly restrict buffer Nodes { ClusterRecord nodes[]; };
layout(scalar, binding = kBindTargets) readonly restrict buffer Targets { Target targets[]; };
layout(scalar, binding = kBindPlacements) readonly restrict buffer Placements { Placement placements[]; };
layout(scalar, binding = kBindRefs) readonly restrict buffer Refs { ClusterRef refs[]; };
layout(scalar, binding = kBindBoxes) restrict buffer Boxes { RefBox boxes[]; };
layout(scalar, binding = kBindMaskScopes) restrict buffer Scopes { uint scopes[]; };
layout(scalar, binding = kBindMaskItems) readonly restrict buffer Items { MaskItem items[]; };
layout(scalar, binding = kBindStates) readonly restrict buffer States { State states[]; };
layout(scalar, binding = kBindTiles) writeonly restrict buffer Tiles { uvec2 tiles[]; };

layout(push_constant) uniform Push { uint first; uint count; uint groupsX; uint plane; } push;

shared uint allTiles[2];
shared bool anyMeets;
shared vec3 lowest[kCluster], highest[kCluster];

// A read first: on most pixels nothing changes, and atomics cost more.
void lower(uint at, uint key) {
  if (key < scopes[at]) atomicMin(scopes[at], key);
}

void raise(uint at, uint key) {
  if (key > scopes[at]) atomicMax(scopes[at], key);
}

// Whether the two depths leave room for a contact within `farthest`; their difference rounds by u.
bool within(float nearest, float from, float farthest) { return (nearest - from) * (1.0 - 4.0 * kUnit) <= farthest; }

// Keeps what a triangle may have at a pixel; returns whether it may meet something there within `farthest`.
bool keep(uint at, vec2 depths, float farthest) {
  const uint nearKey = keyOf(depths.x), farKey = keyOf(depths.y);
  if (kDraws == kMaskFarthest) {
    raise(kScopeF * push.plane + at, farKey);
    return false;
  }
  if (kDraws == kMaskNearest) {
    if (farKey < scopes[kScopeS * push.plane + at]) return false;
    lower(kScopeR * push.plane + at, nearKey);
    return within(depths.x, depthOf(scopes[kScopeM * push.plane + at]), farthest);
  }
  if (nearKey > scopes[kScopeF * push.plane + at]) return false;
  if (kDraws == kMaskSensor) {
    lower(kScopeS * push.plane + at, nearKey);
    raise(kScopeM * push.plane + at, farKey);
    return false;
  }
  return within(depthOf(scopes[kScopeR * push.plane + at]), depths.y, farthest);
}

// Nothing of the other side is there.
bool idle(uint at) {
  if (kDraws == kMaskSensor) return scopes[kScopeF * push.plane + at] == 0;
  if (kDraws == kMaskNearest) return scopes[kScopeS * push.plane + at] == kNobody;
  if (kDraws == kMaskAlive) return scopes[kScopeR * push.plane + at] == kNobody;
  return false;
}

// Where a cluster has no triangle that can be first.
const RefBox kNowhere = RefBox(vec3(3.0e38), vec3(-3.0e38), vec3(0.0));

// Whether the box of cluster `ref` lets it meet one of the other side's within `farthest`.
bool canMeet(uint ref, uint first, uint end, bool isSensor, float farthest) {
  const RefBox box = boxes[ref];
  bool found = false;
  for (uint i = first + gl_LocalInvocationID.x; i < end && !found; i += kLanes) {
    const RefBox other = boxes[i];
    const bool across = all(lessThanEqual(box.lo.xy, other.hi.xy)) && all(lessThanEqual(other.lo.xy, box.hi.xy));
    const float gap = isSensor ? other.lo.z - box.hi.z : box.lo.z - other.hi.z;
    found = across && gap <= farthest && (isSensor ? other.hi.z >= box.lo.z : box.hi.z >= other.lo.z);
  }
  if (found) anyMeets = true;
  barrier();
  return anyMeets;
}

vec3 framed(Rows frameFromMesh, vec3 q) {
  const vec4 p = vec4(q, 1.0);
  return vec3(dot(frameFromMesh[0], p), dot(frameFromMesh[1], p), dot(frameFromMesh[2], p));
}

void main() {
  const uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * push.groupsX;
  if (group >= push.count) return;
  const uint lane = gl_LocalInvocationID.x;
  const MaskItem item = items[push.first + group];
  const Placement placement = placements[refs[item.ref].placement];
  const MeshRecord mesh = meshes[placement.mesh];
  const ClusterRecord node = nodes[mesh.firstNode + refs[item.ref].node];
  const bool isSensor = kDraws == kMaskSensor || kDraws == kMaskAlive;
  const uint firstTiles = kTilesPerCluster * (item.ref + states[item.target].tiles);
  const bool marks = kDraws == kMaskNearest || kDraws == kMaskAlive;
  if (lane < 2) allTiles[lane] = 0;
  if (lane == 0) anyMeets = marks && boxes[item.ref].lo.x <= boxes[item.ref].hi.x;
  barrier();
  if (!marks && !canMeet(item.ref, item.firstOther, item.endOther, isSensor, states[item.target].hi)) {
    if (lane == 0) boxes[item.ref] = kNowhere;
  }
  if (!anyMeets) {
    if (marks && lane == 0) tiles[firstTiles + kCluster] = uvec2(0);
    return;
  }
  const float scale = targets[item.target].pixelsPerUnit;
  const vec3 corner = vec3(targets[item.target].corner[0], targets[item.target].corner[1], 0.0);
  const float farthest = states[item.target].hi * scale * (1.0 + 4.0 * kUnit);
  // `error` holds 8u of a vertex, of which 6 are due; moving it to the corner and scaling adds 2u of it and of the corner.
  const float slack = 2.0 * placement.error * scale + 1e-9;
  const float spread = slack + 8.0 * kUnit * (max(abs(corner.x), abs(corner.y)) * scale + 1.0);
  vec3 low = vec3(3.0e38), high = vec3(-3.0e38);
  for (uint i = lane; i < node.count; i += kLanes) {
    const uvec3 vertex = triangles[mesh.firstIndex / 3 + node.first + i] + mesh.firstVertex;
    const vec3 p0 = framed(placement.frameFromMesh, positions[vertex.x]);
    const vec3 p1 = framed(placement.frameFromMesh, positions[vertex.y]);
    const vec3 p2 = framed(placement.frameFromMesh, positions[vertex.z]);
    const Facet f = facetOf((p0 - corner) * scale, (p1 - corner) * scale, (p2 - corner) * scale, spread, uvec2(0), uvec2(kMaskSide));
    uvec2 tilesAlive = uvec2(0);
    uvec2 next = f.first;
    while (next.y < f.end.y) {
      // Pixels are skipped until one counts: lavapipe runs both sides of an `if`, but leaves a loop.
      bool found = false;
      uint at = 0;
      uvec2 pixel = uvec2(0);
      while (next.y < f.end.y && !found) {
        pixel = next;
        at = item.firstPixel + kMaskSide * pixel.y + pixel.x;
        found = covers(f, vec2(pixel) + 0.5) && !idle(at);
        ++next.x;
        if (next.x == f.end.x) next = uvec2(f.first.x, next.y + 1);
      }
      if (found && keep(at, depthsIn(f, vec2(pixel) + 0.5, slack), farthest)) {
        const uint tile = kTilesPerRow * (pixel.y / kTileSide) + pixel.x / kTileSide;
        tilesAlive |= tile < 32 ? uvec2(1u << tile, 0) : uvec2(0, 1u << (tile - 32));
      }
    }
    if (marks) tiles[firstTiles + i] = tilesAlive;
    if (tilesAlive == uvec2(0)) continue;
    atomicOr(allTiles[0], tilesAlive.x);
    atomicOr(allTiles[1], tilesAlive.y);
    low = min(low, min(min(p0, p1), p2) - placement.error);
    high = max(high, max(max(p0, p1), p2) + placement.error);
  }
  if (!marks) return;
  lowest[lane] = low;
  highest[lane] = high;
  barrier();
  if (lane != 0) return;
  tiles[firstTiles + kCluster] = uvec2(allTiles[0], allTiles[1]);
  for (uint i = 1; i < kLanes; ++i) {
    low = min(low, lowest[i]);
    high = max(high, highest[i]);
  }
  boxes[item.ref].lo = low;
  boxes[item.ref].hi = high;
}
