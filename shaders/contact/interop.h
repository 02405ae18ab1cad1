// What the contact tier's passes share with each other and with C++ (engine/contact). Units are the scene's, unless a
// member is "scaled": then lengths are multiplied by Sensor::scale, a power of two that makes the sensor about 1 large, so
// that floats hold what a search deals with, whatever the scene's unit.
#ifndef RADAR_CONTACT_INTEROP_H
#define RADAR_CONTACT_INTEROP_H

#include "../interop.h"

#ifdef __cplusplus
namespace radar {
struct Result;
namespace gpu {
#define INTEROP_CONST inline constexpr uint
#else
#define INTEROP_CONST const uint
#endif

// What a search asks.
struct Sensor {
  Placement placement;
  Rows frame;      // world axes of the sensor's frame: across, across, along the motion
  Point direction; // unit, world
  float scale;
  Point centre;    // of the sensor's box in the world, about the anchor of the tree over objects
  float distance;  // D, scaled, rounded up
  Point halfExtent;
  float enough;    // scaled: a contact certainly before this ends the search; below 0 unless only "within D or not" is asked
  uint mask;
  uint firstExcluded;  // of the excluded objects' ids
  uint endExcluded;
  float unscale;  // 1 / scale; not every device divides by a power of two exactly
};
INTEROP_CONST kSensorTexels = 19;

// The same search in double precision.
struct Sweep {
  PreciseRows pose;
  double direction[3];
  double directionLength;
  double distance;  // D
  uint decides;     // only "within D or not" is asked
  uint result;      // where its answer goes
  float scale;      // as of the Sensor
  float start;      // Sensor::distance: what SearchState::hi is as long as nothing is met
};

struct SearchState {
  uint hi;     // bits of a float of at least 0: first contact is certainly no later, scaled; at first Sensor::distance
  uint flags;  // kSearch*
};
INTEROP_CONST kSearchLost = 1;        // a list was full
INTEROP_CONST kSearchOutOfRange = 2;  // an object in reach is too large or too small, beside the sensor, for floats
INTEROP_CONST kSearchUnfinished = 4;  // the rounds recorded were not enough

// A pair of nodes, or a node of the tree over objects, that is yet to be searched.
struct SearchTask {
  uint sensor;
  uint object;  // kNobody: `b` is a link of the tree over objects
  uint a;       // the node that stays; or, with kLinkLeaf, the left of two children that are tried, as
  uint b;       // the other side's
  float gap;    // nothing below meets before, scaled
};

// A pair of triangles that may be first, as far as floats can tell.
struct PairCandidate {
  uint sensor;
  uint object;
  uint slotA;  // Triangle
  uint slotB;
  float low;   // it does not meet before, scaled
};

// One of those that may be first once the search has ended; in double precision where the device has it.
struct Contender {
  double low;    // it does not meet before
  double at;     // of the feature that certainly meets, in multiples of the direction, and how far that may be off;
  double error;  // only if kContenderMeets
  uint sensor;
  uint object;
  uint slotA;
  uint slotB;
  uint flags;    // kContender*, and the feature that attains `at` in the low bits
  uint next;
  float first;   // `low`, scaled, rounded down
  uint padding;
};
INTEROP_CONST kContenderPierces = 0x400;  // certainly meets at the start
INTEROP_CONST kContenderMeets = 0x200;    // certainly, no later than at + error
INTEROP_CONST kContenderSharp = 0x100;    // certainly first at `at`, and nothing of it may come earlier

// A pair that the device cannot decide, for the host: its name, its corners as given, and the object's pose.
struct UnresolvedPair {
  uint sensor;
  uint object;
  uint triB;
  uint triA;
  Point a[3];
  Point b[3];
  PreciseRows pose;
};

// Of one round of the search.
struct SearchRound {
  uint tasks;    // there are
  uint taken;    // of these; may be more
  uint spilled;  // left behind by those that ran out of time
};
INTEROP_CONST kMostRounds = 64;

// Of a submission.
struct SearchCounts {
  uint filterGroups[3];  // VkDispatchIndirectCommand for all candidates
  uint candidates;       // found, kept up to the capacity
  uint contenders;
  uint unresolved;       // found, kept up to the capacity
  uint broken;           // the device runs a workgroup as several subgroups
  uint nodePairs;        // looked at; low word
  uint nodePairsHigh;
  uint trianglePairs;    // that reached the triangle test
  uint trianglePairsHigh;
  uint solves;
  uint solvesHigh;
  SearchRound rounds[kMostRounds + 1];
};

struct SearchPush {
  uint round;
  uint taskCapacity;
  uint candidateCapacity;
  uint budget;  // iterations after which an invocation leaves the rest behind
  uint width;   // fewer tasks than this are split soon
};
struct CollectPush {
  uint round;
  uint taskCapacity;
  uint isLast;  // no round follows, nor is the search gone on with
};
struct FilterPush {
  uint candidateCapacity;
};
struct ResolvePush {
  uint sensors;
  uint unresolvedCapacity;
};
// Invocations in a workgroup of collect, filter, refine and resolve.
INTEROP_CONST kContactGroup = 64;
// Workgroups of collect.
INTEROP_CONST kCollectGroups = 32;

INTEROP_SLOT(kSlotSensors, 5, Sensor);
INTEROP_SLOT(kSlotStates, 6, SearchState);
INTEROP_SLOT(kSlotCounts, 7, SearchCounts);
INTEROP_SLOT(kSlotTasks, 8, SearchTask);
INTEROP_SLOT(kSlotSpilled, 9, SearchTask);
INTEROP_SLOT(kSlotPairCandidates, 10, PairCandidate);
INTEROP_SLOT(kSlotContenders, 11, Contender);
INTEROP_SLOT(kSlotSweeps, 12, Sweep);
INTEROP_SLOT(kSlotExcluded, 14, uint);
INTEROP_SLOT(kSlotResults, 15, Result);
INTEROP_SLOT(kSlotUnresolved, 16, UnresolvedPair);
INTEROP_SLOT(kSlotHeads, 18, uint);  // one a sensor: its first Contender, linked by `next`, or kNobody

#ifdef __cplusplus
}  // namespace gpu
}  // namespace radar
#endif
#undef INTEROP_CONST
#endif
