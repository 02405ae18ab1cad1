// Shared by contact_margins_test and its shader.
#ifndef RADAR_CONTACT_MARGINS_INTEROP_H
#define RADAR_CONTACT_MARGINS_INTEROP_H

#include "shaders/contact/interop.h"

#ifdef __cplusplus
namespace radar::test {
using uint = uint32_t;
using Point = gpu::Point;
#endif

// A pair of triangles that touch, a node of each mesh's tree above them, and the object's leaf in the tree over
// objects.
struct Touch {
  uint sensor, object;
  uint nodeA, nodeB, slotA, slotB;
  uint objectNode;
  float limit;      // scaled distance that the sensor moves until they touch, rounded up
  float clearance;  // scaled, rounded up
  float nearLimit;  // scaled distance that the sensor moves until they are that near, rounded up
};

// The search's bounds for such a pair.
struct PairBounds {
  Point anchorA;
  float errorA;
  Point cornersA[3];
  float errorB;
  Point cornersB[3];
  float gap;  // of the nodes
  float boxGap, boxEnd;
  float from;     // of the triangles
  float pairGap;  // of the triangles, once solved
  uint inRange;
  // With the clearance.
  float gapNear;     // of the nodes
  float nearFrom;    // of the triangles
  float nearLow, nearBy;
};

INTEROP_SLOT(kSlotTouches, 20, Touch);
INTEROP_SLOT(kSlotPairBounds, 21, PairBounds);

#ifdef __cplusplus
}  // namespace radar::test
#endif
#endif
