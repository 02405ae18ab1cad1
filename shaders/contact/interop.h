// Structs of the contact tier's passes, shared with C++ (engine/contact). Units are the scene's, except for "scaled"
// members: those lengths are multiplied by Sensor::scale, a power of two that makes the sensor's size about 1, so that
// floats suffice for a search in any unit.
#ifndef RADAR_CONTACT_INTEROP_H
#define RADAR_CONTACT_INTEROP_H

#include "../shared/interop.h"

#ifdef __cplusplus
namespace radar {
struct Result;
namespace gpu {
#endif

// A search as the CPU states it, or plan.comp for a host's shader; encode.comp makes a Sensor of it. Lengths are the world's;
// those with an exponent are the mantissas of lengths.
struct StatedSearch {
  float clearance;   // rounded up
  float tolerance;   // of it, as asked, rounded up
  float slackShare;  // by how much a default slack may move a corner, as a share of both placements' errors
  float slack;       // by which the sensor's vertices may be moved, rounded up
  int exponent;      // of `way`, `certain`, `stopBefore`
  float way;         // to the end, rounded up
  float certain;     // as `way`, and of a step rounded down
  float stopBefore;  // see Sensor
  float perWay;      // of a step: t per way, rounded down; negative if nothing moves; of a sweep 0
  uint mesh;
  uint mask;
  uint firstExcluded;  // in the list of excluded objects
  uint endExcluded;
  uint start;  // link of the tree over objects at which the search starts, or kWholeTree; kNobody: there is nothing to search
  uint flags;  // SearchState::flags, if it cannot be searched
};
INTEROP_CONST kWholeTree = 0;  // the root's link, whatever it is

// The input of a search.
struct Sensor {
  Placement placement;
  Point across;    // unit axes of the sensor's frame in the world: across the motion, across, along
  float clearance; // scaled, rounded up
  Point upwards;
  float slackShare;  // by how much a default slack may move a corner, as a share of both placements' errors
  Point along;
  float tolerance; // of the clearance, scaled, rounded up
  Point direction; // unit, world
  float scale;
  Point centre;    // of the sensor's box in the world, about the anchor of the tree over objects
  float distance;  // D, scaled, rounded up
  Point halfExtent;
  float stopBefore;  // scaled: a certain contact before this ends the search; negative unless the query has `anyHit`
  uint mask;
  uint firstExcluded;  // in the list of excluded objects
  uint endExcluded;
  float unscale;  // 1 / scale; since some devices divide by powers of two inexactly
};
INTEROP_CONST kSensorTexels = 19;

// The same search in double precision.
struct Sweep {
  PreciseRows pose;
  double direction[3];
  double directionLength;  // world units; stated negative if only encode.comp finds it
  double distance;         // t at the end: D, of a step 1
  uint anyHit;      // the query has `anyHit`
  uint result;      // index of its answer
  float scale;      // see Sensor
  float start;      // SearchState::hi below this is that of a certain contact before the end
  uint ignoreLeaving;  // only pairs that block count
  uint isMirrored;     // the pose turns the mesh inside out
  uint cpuDecides;     // all pairs that may be first: with a clearance, or if encode.comp cannot find the length
  float stepPerUnit;   // of a step: t per scaled length, rounded down; negative if nothing moves; of a sweep 0
  double slack;        // radar::Query::slack; negative: by default
  double magnitude;    // of the placed mesh, for the default; stated negative if only the device knows the mesh
  double perParameter; // t per `direction`; stated negative if that is its length
  double drift[3];     // of a step: the object's displacement
};

struct SearchState {
  uint hi;     // bits of a float, at least 0: upper bound on first contact, scaled; initially Sensor::distance
  uint flags;  // kSearch*
  uint least;  // the least object that certainly meets at the start, or kNobody; no greater object can be the answer
};
INTEROP_CONST kSearchLost = 1;        // a list was full
INTEROP_CONST kSearchOutOfRange = 2;  // an object in reach is too large or too small relative to the sensor, for floats
INTEROP_CONST kSearchUnfinished = 4;  // more rounds were needed than recorded
INTEROP_CONST kSearchWithin = 8;      // something certainly is within the clearance at the start: the search has ended
INTEROP_CONST kSearchNoQuery = 16;    // a host's shader has written no valid query

// A pair of nodes, or a node of the tree over objects, still to be searched.
struct SearchTask {
  uint search;
  uint object;  // kNobody: `b` is a link of the tree over objects
  uint a;       // a node of the sensor's mesh; or, with kLinkLeaf, the left of two children to try
  uint b;       // a node of the object's mesh; or, without kLinkLeaf in `a`, the left of two children to try
  float gap;    // no contact of this pair before this, scaled
};

// An entry of a workgroup's queues: a pair of leaves, whose links `a` and `b` are; or of triangles, whose slots they are.
struct QueuedPair {
  Quadruple pair;  // a, b, object, search
  float gap;       // of leaves: no contact before this, scaled
};

// A pair of triangles that may be first, according to floats.
struct CandidatePair {
  uint search;
  uint object;
  uint slotA;  // Triangle
  uint slotB;
  float low;   // no contact before this, scaled
  uint feature;  // that certainly meets first of those that certainly meet, its corners not sorted; else not below kFeatures
};

// A pair that may still be first after the search; in double precision if the device has it.
struct RefinedPair {
  double low;    // no contact before this
  double at;     // contact of the certain feature, in multiples of the direction, and its error bound;
  double error;  // only if kPairMeets
  uint search;
  uint object;
  uint slotA;
  uint slotB;
  uint flags;    // kPair*, the feature that attains `at` in the low bits, and from bit kPairCorners on Impact::corners
  uint next;
  float first;   // `low`, scaled, rounded down
  uint open;     // no property of this pair, but an entry of a list: an index of a pair that may not block, or not meet as it seems
  uint left;     // likewise of one that certify.comp leaves; at last, of a search's first pair: that which describe.comp
                 // describes, or kNobody
  uint feature;  // of a CandidatePair
};
INTEROP_CONST kPairCorners = 16;
INTEROP_CONST kPairBlocks = 0x1000;  // certainly; set only where a query ignores what does not
INTEROP_CONST kPairParted = 0x800;   // certainly does not meet at or after the start
INTEROP_CONST kPairPierces = 0x400;  // certainly meets at the start
INTEROP_CONST kPairMeets = 0x200;    // certainly, no later than at + error
INTEROP_CONST kPairSharp = 0x100;    // certainly begins at `at`, no earlier

// A pair that the device leaves to the CPU: its ids, its corners in the order of their meshes, and the object's pose.
struct UnresolvedPair {
  uint search;
  uint object;
  uint triB;
  uint triA;
  uint mesh;  // the object's
  uint pad;
  Point a[3];
  Point b[3];
  PreciseRows pose;
};

// Counts of one round of the search.
struct SearchRound {
  uint tasks;    // number of tasks
  uint taken;    // tasks taken; may exceed `tasks`
  uint spilled;  // tasks left by invocations that ran out of budget
  uint aside;    // room kept for those of all workgroups but the first, and taken by them
};
INTEROP_CONST kMostRounds = 64;

// What drivers do that the search cannot do with: run a workgroup as several subgroups, end loops early, or let lanes go apart
// where all are needed.
INTEROP_CONST kBrokenSubgroups = 1;
INTEROP_CONST kBrokenLoops = 2;
INTEROP_CONST kBrokenLanes = 3;

// What lanes of the search do, one at a time: test a node of the tree over objects, enter an object, test a pair of nodes, of
// leaves; solve a pair of triangles.
INTEROP_CONST kWorkObjectNode = 0;
INTEROP_CONST kWorkObject = 1;
INTEROP_CONST kWorkNodePair = 2;
INTEROP_CONST kWorkLeafPair = 3;
INTEROP_CONST kWorkSolve = 4;
INTEROP_CONST kWorks = 5;

// Counts of a submission.
struct SearchCounts {
  uint filterGroups[3];  // VkDispatchIndirectCommand for all candidates
  uint refineGroups[3];  // the same for the pairs that certify.comp leaves
  uint openGroups[3];    // and for open pairs
  uint candidates;       // found; stored up to the capacity, and above it no exact count
  uint refinedPairs;
  uint leftPairs;        // that certify.comp leaves
  uint openPairs;        // of RefinedPair::open
  uint unresolved;       // found; stored up to the capacity
  uint broken;           // kBroken*: no answer counts
  uint trianglePairs;    // tested; low word
  uint trianglePairsHigh;
  uint queries;          // written by a host's shader, as far as they count
  uint serial;           // of the recording; its copy on the host tells which was the last to be executed
  uint done[kWorks];     // times a lane did it, if the search counts its work;
  uint steps[kWorks];    // and times that it could have, had it had something to do
  SearchRound rounds[kMostRounds + 1];
};

struct EncodePush {
  uint count;       // searches
  Point anchor;     // of the tree over objects, which is the sum of this
  Point anchorLow;  // and this
};
struct SearchPush {
  uint round;
  uint taskCapacity;
  uint candidateCapacity;
  uint budget;  // iterations after which an invocation stops
  uint width;   // below this number, tasks are split early
};
struct CollectPush {
  uint round;
  uint taskCapacity;
  uint isLast;  // no round follows, and the search is not continued
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
INTEROP_SLOT(kSlotCandidatePairs, 10, CandidatePair);
INTEROP_SLOT(kSlotRefinedPairs, 11, RefinedPair);
INTEROP_SLOT(kSlotSweeps, 12, Sweep);
INTEROP_SLOT(kSlotExcluded, 14, uint);
INTEROP_SLOT(kSlotResults, 15, Result);
INTEROP_SLOT(kSlotUnresolved, 16, UnresolvedPair);
INTEROP_SLOT(kSlotQueuedPairs, 30, QueuedPair);
INTEROP_SLOT(kSlotStated, 23, StatedSearch);
INTEROP_SLOT(kSlotHeads, 18, uint);  // one per sensor: its first RefinedPair, linked by `next`, or kNobody

#ifdef __cplusplus
}  // namespace gpu
}  // namespace radar
#endif
#endif
