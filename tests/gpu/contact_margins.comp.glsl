// Evaluates the search's bounds for pairs that are known to touch.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#define RADAR_NO_DOUBLES
#include "tests/gpu/contact_margins_interop.h"
#include "shaders/shared/triangle_pair_bounds.glsl"
#include "shaders/shared/scene.glsl"
#include "shaders/contact/nodes.glsl"
// Of the pair in hand.
float clearance = 0.0;
float clearanceOf(uint sensor) { return clearance; }
#include "shaders/contact/node_pair.glsl"
#include "shaders/contact/triangle_pair.glsl"
#include "shaders/contact/reach.glsl"
#include "shaders/contact/within_clearance.glsl"

layout(local_size_x = 64) in;

layout(scalar, binding = kSlotTouches) readonly restrict buffer Touches { Touch touches[]; };
layout(scalar, binding = kSlotPairBounds) writeonly restrict buffer Bounds { PairBounds pairBounds[]; };

layout(push_constant) uniform PushConstants { uint count; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  const Touch t = touches[i];
  PairBounds found;
  const int node = int(2 * t.objectNode);
  const vec2 box = meetsBox(sensorBoxOf(t.sensor), uintBitsToFloat(texelFetch(objectNodeTexels, node)),
                            uintBitsToFloat(texelFetch(objectNodeTexels, node + 1)));
  found.boxGap = box.x;
  found.boxEnd = box.y;
  const MeshPair meshes = meshPairOf(t.sensor, t.object);
  found.inRange = meshes.inRange ? 1 : 0;
  const Node nodeA = nodeAt(t.nodeA), nodeB = nodeAt(t.nodeB);
  found.gap = approachOf(meshes, nodeA, nodeB, t.limit).gap;
  const PairFrame f = pairFrameOf(t.sensor, t.object, vertexAt(triangleAt(t.slotA).x), vertexAt(triangleAt(t.slotB).x));
  const PlacedTriangle a = placedTriangle(f.a, t.slotA), b = placedTriangle(f.b, t.slotB);
  found.anchorA = f.a.anchor;
  found.cornersA = a.corners;
  found.cornersB = b.corners;
  found.errorA = a.error;
  found.errorB = b.error;
  found.from = meetsFrom(a, b, 0.0, t.limit);
  const ImpactFloat m = impactOf(a.corners, b.corners, differenceError(a, b));
  found.pairGap = m.isOver ? kMiss : max(min(firstOf(m), m.unknown), 0.0);
  clearance = t.clearance;
  const MeshPair apart = meshPairOf(t.sensor, t.object);
  found.gapNear = max(approachOf(apart, nodeA, nodeB, t.nearLimit).gap,
                      reachedFrom(t.sensor, t.object, nodeA, nodeB, clearance, apart.farthest, t.nearLimit));
  found.nearFrom = meetsFrom(a, b, clearance, t.nearLimit);
  const WithinClearance within = withinClearance(a, b, clearance, t.limit);
  found.nearLow = within.low;
  found.nearBy = within.by;
  pairBounds[i] = found;
}
