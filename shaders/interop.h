// Structs, sentinels, group sizes and binding numbers shared by C++ and GLSL (scalar layout); tests/unit compares the
// offsets.
#ifndef RADAR_INTEROP_H
#define RADAR_INTEROP_H

#include "slot.h"

#ifdef __cplusplus
#include <cstdint>
namespace radar::gpu {
using uint = uint32_t;
// A 3x4 matrix, row-major.
using Rows = float[12];
using PreciseRows = double[12];
using Point = float[3];
#define INTEROP_CONST inline constexpr uint
#else
// Vectors, because lavapipe loads a vector as fast as a scalar.
#define Rows vec4[3]
#define Point vec3
#ifdef RADAR_NO_DOUBLES  // the bits of doubles, for shaders that do no arithmetic with them
#define double uvec2
#define PreciseRows uvec4[6]
#else
#define PreciseRows dvec4[3]
#endif
#define INTEROP_CONST const uint
#endif

INTEROP_CONST kNobody = 0xffffffffu;

// The window has 16 x 16 cells; each nominates its pixel of least L. One workgroup reduces one sensor, one invocation
// one cell.
INTEROP_CONST kCellsPerSide = 16;
INTEROP_CONST kCells = 256;
// Candidates are identified and solved in order of (L, pixel), kRound at a time, until one meets.
INTEROP_CONST kRound = 64;
// Room for pairs of one sensor that the device leaves to the CPU, in order of candidates: one round, which is what a
// device without doubles leaves.
INTEROP_CONST kOpenPairs = 64;
// Triangles of one draw per identify workgroup. Each invocation takes several, since loading the draw's matrix costs as
// much as a triangle.
INTEROP_CONST kItemTriangles = 512;
INTEROP_CONST kItemInvocations = 64;

// ---- trees, as both searches walk them ---------------------------------------------------------------------------------

// A node's link: the left child, which the right one follows; or, with kLinkLeaf, the first triangle or the object of a
// leaf. With kLinkPair the leaf also holds the next triangle.
INTEROP_CONST kLinkLeaf = 0x80000000u;
INTEROP_CONST kLinkPair = 0x40000000u;
INTEROP_CONST kLinkItem = 0x3fffffffu;

// A node of the tree over a mesh's triangles: a box of normalised vertices, and the slab |normal . q - slabMiddle| <=
// slabHalf.
struct MeshNode {
  Point centre;
  uint link;
  Point halfExtent;
  float slabMiddle;
  Point normal;
  float slabHalf;
};

// A node of the tree over objects: a world box, relative to the tree's anchor.
struct ObjectNode {
  Point centre;
  uint link;
  Point halfExtent;
  uint pad;
};

// Vertices and triangles; one buffer each for all meshes.
struct Vertex {
  Point position;  // as given
  uint pad;
};
struct Triangle {
  uint corners[3];  // vertices
  uint id;          // within its mesh
};

// A mesh in the world, for float arithmetic: its normalised vertices q (engine/scene/scene.h) are at matrix q + position.
struct Placement {
  Rows coarse;   // the leading 16 bits of the matrix; in [3] of each row the leading bits of the position
  Rows fine;     // the remainder
  Rows inverse;  // rows n_k with n_k . matrix close to the k-th unit vector; in [3] the vertex error that this causes
  Point reach;   // greatest |q|
  uint root;     // of the mesh's nodes
  Point origin;  // q = (vertex - origin) * perUnit
  float perUnit;
  float error;   // bound on the vertex error of coarse + fine on any axis
  float size;    // bound on a vertex's distance from the position, as a sum over the axes
  uint mask;     // of an object
  uint mesh;
};
INTEROP_CONST kPlacementTexels = 12;

struct MeshRecord {
  Point origin;   // of local vertices
  Point lo;       // of local vertices
  Point hi;
  float unit;     // normalised vertices = local * perUnit
  float perUnit;  // 1 / unit
  uint firstVertex;
  uint firstTriangle;
  uint firstNode;
};

struct ObjectRecord {
  PreciseRows pose;
  uint mesh;
  uint pad;
};

INTEROP_SLOT(kSlotMeshNodes, 0, MeshNode);
INTEROP_SLOT(kSlotObjectNodes, 1, ObjectNode);
INTEROP_SLOT(kSlotVertices, 2, Vertex);
INTEROP_SLOT(kSlotTriangles, 3, Triangle);
INTEROP_SLOT(kSlotPlacements, 4, Placement);  // one per object
INTEROP_SLOT(kSlotObjects, 13, ObjectRecord);
INTEROP_SLOT(kSlotMeshes, 17, MeshRecord);

// ---- the sampled tier --------------------------------------------------------------------------------------------------

// One sensor. Lengths are in world units along the motion from the sensor's back plane, unless noted otherwise.
struct View {
  PreciseRows pose;
  double direction[3];
  double directionLength;
  double distance;       // D
  double size;           // of the sensor: what "1e-6 of the size" refers to
  uint mesh;
  uint layer;
  uint resolution;       // pixels of the layer's viewport, both ways
  uint width;            // pixels of the window
  uint height;
  uint cell;             // side of a cell, pixels, even
  float rangeScale;      // R = rangeScale * stored
  float maskBase;        // position of the sensor's surface = maskBase - maskScale * stored
  float maskScale;
  float slack;           // rounding of R and M: L this far below 0 may be a contact at the start
  float rangeLimit;      // stored R of d, the end of the target volume
  uint pad;
};

// One mesh placed in one view: an instance of a depth-only draw.
struct Draw {
  float clipFromMesh[12];  // local vertices -> normalised device coordinates, w = 1
  Point origin;            // of local vertices
  float snap;              // largest distance of a covered pixel centre from a triangle, pixels
  float slack;             // rounding of the depth it stores
  uint view;
  uint layer;              // within the render pass
  uint mesh;
  uint object;             // kNobody: the sensor
};

// kItemTriangles triangles of a draw. A view's items are ordered by (object, triangle), so the least (item, lane) is
// the least (object, triangle).
struct Item {
  uint draw;
  uint firstTriangle;
  uint endTriangle;
};

struct Candidate {
  uint pixel;     // x | y << 16
  float range;    // stored R
  float mask;     // stored M
  uint itemB;     // kItemTriangles * item + lane of the scene's triangle there
  uint itemA;     // the same for the sensor
};

struct Answer {
  double hi;       // upper end of the best solved pair, world units; only if object != kNobody
  uint object;
  uint triB;
  uint triA;
  uint feature;    // the feature that attains hi (solve.comp)
  float minL;      // the paper's min(L)
  uint flags;      // kAnswer*
  uint candidates;
  uint pairs;      // distinct pairs solved
  uint openPairs;
  uint pad;
};

struct OpenPair {
  double low;  // no contact before this, world units
  uint object;
  uint triB;
  uint triA;
  uint pad;
};
INTEROP_CONST kAnswerDetected = 1;  // some R < d
INTEROP_CONST kAnswerHasL = 2;      // minL exists

INTEROP_SLOT(kSlotViews, 5, View);
INTEROP_SLOT(kSlotDraws, 6, Draw);
INTEROP_SLOT(kSlotItems, 7, Item);
INTEROP_SLOT(kSlotCandidates, 8, Candidate);  // kCells per view
INTEROP_SLOT(kSlotRanks, 9, uint);            // kCells per view: the cell's candidate, or kNobody
INTEROP_SLOT(kSlotAnswers, 10, Answer);
INTEROP_SLOT(kSlotRange, 11, SampledImage);   // depth of R, one layer per view
INTEROP_SLOT(kSlotMask, 12, SampledImage);    // depth of M, one layer per view
INTEROP_SLOT(kSlotOpenPairs, 14, OpenPair);   // kOpenPairs per view

// ---- pairs of triangles ------------------------------------------------------------------------------------------------

// Features: 0..2 vertex i of the sensor's triangle on the other's face; 3..5 vertex i-3 of the scene's triangle on the
// sensor's face; 6 + 3*i + j: edge i of the sensor's triangle and edge j of the scene's, edges being (0,1), (1,2), (0,2).
INTEROP_CONST kFeatureEdges = 6;

// ---- a host's geometry -------------------------------------------------------------------------------------------------

// Component type of a vertex position.
INTEROP_CONST kFloat32 = 0;
INTEROP_CONST kFloat16 = 1;
INTEROP_CONST kSnorm16 = 2;
INTEROP_CONST kUnorm16 = 3;

// One vertex and one object that are outside their bounds, or not finite. kNobody: none.
struct Stray {
  uint mesh;
  uint vertex;
  uint object;
};

// An object that a host moves.
struct Moved {
  uint object;
  uint mesh;
  uint firstByte;    // of its transform, which is 12 floats
  Point anchor;      // middle of its bounds, world
  Point halfExtent;  // of its bounds about the anchor
};

INTEROP_SLOT(kSlotWords, 5, uint);  // words copied from the host's buffers
INTEROP_SLOT(kSlotMoved, 6, Moved);
INTEROP_SLOT(kSlotStray, 7, Stray);
INTEROP_SLOT(kSlotRefitNodes, 8, uint);  // nodes of deformed meshes, deepest first

// ---- what a device's arithmetic is tried with ---------------------------------------------------------------------------

INTEROP_CONST kTrials = 1024;
INTEROP_CONST kTrialGroup = 64;

// The operations checked. A check can be told to falsify one of them, to show that it would be found.
INTEROP_CONST kNoOperation = 0;
INTEROP_CONST kFloatSum = 1;
INTEROP_CONST kFloatProduct = 2;
INTEROP_CONST kFloatQuotient = 3;
INTEROP_CONST kFloatChain = 4;  // x * y + z under `precise`
INTEROP_CONST kFloatInverseRoot = 5;
INTEROP_CONST kFloatOrder = 6;
INTEROP_CONST kFloatOfInteger = 7;
INTEROP_CONST kFloatCopy = 8;
INTEROP_CONST kFloatSubnormal = 9;
INTEROP_CONST kDoubleSum = 10;
INTEROP_CONST kDoubleProduct = 11;
INTEROP_CONST kDoubleQuotient = 12;
INTEROP_CONST kDoubleCorrected = 13;  // quotient() of divide.glsl
INTEROP_CONST kDoublePlaced = 14;     // the formula of Pose
INTEROP_CONST kDoubleOrder = 15;
INTEROP_CONST kDoubleOfFloat = 16;
INTEROP_CONST kFloatOfDouble = 17;
INTEROP_CONST kDoubleCopy = 18;
INTEROP_CONST kOperations = 19;

struct FloatTrial {
  float x, y, z;
  uint integer;  // below 2^24
  float copied;
};

struct FloatOutcome {
  float sum, product, quotient, chain, inverseRoot, ofInteger, copied;
  uint order;  // 1: x < y, 2: min(x, y) is x, 4: max(x, y) is x
};

struct DoubleTrial {
  double x, y;
  double row[4];
  Point p;
  uint pad;
};

struct DoubleOutcome {
  double sum, product, quotient, corrected, placed, ofFloat, copied;
  float ofDouble;
  uint order;  // as above
};

INTEROP_SLOT(kSlotFloatTrials, 0, FloatTrial);
INTEROP_SLOT(kSlotFloatOutcomes, 1, FloatOutcome);
INTEROP_SLOT(kSlotDoubleTrials, 0, DoubleTrial);
INTEROP_SLOT(kSlotDoubleOutcomes, 1, DoubleOutcome);

#ifdef __cplusplus
}  // namespace radar::gpu
#endif
#undef INTEROP_CONST
#endif
