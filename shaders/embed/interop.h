// Structs of the passes that read a host's geometry, shared with C++ (engine/embed).
#ifndef RADAR_EMBED_INTEROP_H
#define RADAR_EMBED_INTEROP_H

#include "../shared/interop.h"

#ifdef __cplusplus
namespace radar::gpu {
#endif

// Component type of a vertex position.
INTEROP_CONST kFloat32 = 0;
INTEROP_CONST kFloat16 = 1;
INTEROP_CONST kSnorm16 = 2;
INTEROP_CONST kUnorm16 = 3;

// One vertex and one object that are outside their bounds, or not finite. kNobody: none.
struct BoundsViolation {
  uint mesh;
  uint vertex;  // Vertex::number
  uint object;
};

// How a transform lies in memory: bytes from row to row and from column to column.
struct MatrixLayout {
  uint row;
  uint column;
};

// The bounds of a mesh that a host deforms without having declared any: numbers in the order of the floats that are their
// least and greatest coordinates, the latter's negated. kNobody: none yet.
struct Extent {
  uint lo[3];
  uint hi[3];
};

// An object that a host moves, or one that stands while the host deforms its mesh without bounds.
struct Moved {
  uint object;
  uint mesh;
  uint mask;
  uint firstByte;  // of its transform; kNobody: it stands where the scene has it
  MatrixLayout format;
  uint leaf;         // of the tree over objects, to be fitted to the object; kNobody: it has bounds
  Point anchor;      // middle of its bounds, world
  Point halfExtent;  // of its bounds about the anchor; without bounds, the most of its coordinates
};

// A mesh that a host deforms. Workgroups of deform.comp and bound.comp, which have these numbers, take one mesh each.
INTEROP_CONST kByDeform = 0;
INTEROP_CONST kByBound = 1;
struct Deformed {
  uint firstGroup[2];  // its first workgroup of each; of meshes with bounds, bound.comp takes none
  uint mesh;
  uint vertices;
  uint triangles;
  uint firstByte;  // of the first position, in the copied words
  uint stride;     // bytes from one position to the next
  uint format;     // kFloat32 ...
  uint extent;     // index of its Extent; kNobody: it has declared bounds
};

// A node of a deformed mesh.
struct RefitNode {
  uint mesh;
  uint node;  // of the mesh
};

// A part of the tree over objects that is built anew where a host moves some: the leaf of one of them, or a largest subtree in
// which nothing moves.
struct Part {
  uint code;  // its place in space: neighbours share leading bits
  uint node;
};

// A query that several searches answer together, each past one object.
struct Gathered {
  uint query;   // index of the query's answer
  uint first;   // of the searches' answers, which ascend by object
  uint count;   // of searches
  uint list;    // index of the first entry of the query's list
  uint listed;  // entries
};

struct DeformedPush {
  uint meshes;
  uint groups;
};
struct NormalisePush {
  uint count;  // meshes
};
struct RefitPush {
  uint first;  // in the list of nodes to refit
  uint count;
};
struct PartsPush {
  uint count;  // parts
};
struct SortPush {
  uint count;  // parts
  uint run;    // that are sorted so far
};
struct FitPush {
  uint count;  // parts
  uint first;  // node of those built
};
struct MovePush {
  uint count;       // objects
  Point anchor;     // of the tree over objects, which is the sum of this
  Point anchorLow;  // and this
};
struct PlanPush {
  uint queries;     // the most
  uint stride;      // bytes from one query to the next, in the copied words
  uint countByte;   // of the number of queries, in the copied words; kNobody: all count
  uint meshes;      // in the list of meshes
  uint start;       // StatedSearch::start
  uint inRange;     // floats can hold the tree over objects
};
struct InvalidatePush {
  uint count;  // results
};
struct GatherPush {
  uint queries;
  uint searches;  // of all of them
  uint first;     // index of the first search's answer
};
// Members of a radar::HostQuery, bytes from its beginning.
INTEROP_CONST kQueryDirection = 48;
INTEROP_CONST kQueryDistance = 60;
INTEROP_CONST kQueryMesh = 64;
INTEROP_CONST kQueryMask = 68;
INTEROP_CONST kQueryExclude = 72;
INTEROP_CONST kQueryFlags = 76;
INTEROP_CONST kQueryAnyHit = 1;
// Invocations in a workgroup of the passes.
INTEROP_CONST kHostGroup = 64;
INTEROP_CONST kGatherGroup = 128;
// Triangles that an invocation of bound.comp takes.
INTEROP_CONST kBoundRun = 16;
// Runs that a pass of sort.comp merges.
INTEROP_CONST kSortRuns = 8;

INTEROP_SLOT(kSlotWords, 19, uint);  // words copied from the host's buffers
INTEROP_SLOT(kSlotMoved, 24, Moved);
INTEROP_SLOT(kSlotBoundsViolation, 25, BoundsViolation);
INTEROP_SLOT(kSlotDeformed, 31, Deformed);
INTEROP_SLOT(kSlotRefitNodes, 26, RefitNode);  // roots first
INTEROP_SLOT(kSlotGathered, 27, Gathered);
INTEROP_SLOT(kSlotOrder, 29, uint);  // of searches
INTEROP_SLOT(kSlotParts, 28, uint);          // nodes
INTEROP_SLOT(kSlotUnsorted, 20, Part);
INTEROP_SLOT(kSlotSorted, 32, Part);
INTEROP_SLOT(kSlotReached, 33, uint);
INTEROP_SLOT(kSlotUnbounded, 21, uint);      // meshes
INTEROP_SLOT(kSlotExtents, 22, Extent);      // of those

#ifdef __cplusplus
}  // namespace radar::gpu
#endif
#endif
