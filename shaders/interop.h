// What both languages must agree on: structs, sentinels, group sizes, binding numbers. Compiled by C++ and by GLSL
// (scalar layout); tests/unit compares the offsets.
#ifndef RADAR_INTEROP_H
#define RADAR_INTEROP_H

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
// As vectors: lavapipe loads a vector in the time of a number.
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

// The window is cut into 16 x 16 cells; each nominates the pixel of its least L. One workgroup reduces one sensor, one
// invocation a cell.
INTEROP_CONST kCellsPerSide = 16;
INTEROP_CONST kCells = 256;
// Candidates are identified and solved in the order of (L, pixel), kRound at a time, until one meets.
INTEROP_CONST kRound = 64;
// Pairs of one sensor that the device cannot decide, kept for the CPU, in the order of their candidates: a round of them,
// which is what a device without doubles leaves to it.
INTEROP_CONST kOpenPairs = 64;
// An identify workgroup takes this many triangles of one draw, each invocation several: loading the draw's matrix costs
// as much as a triangle.
INTEROP_CONST kItemTriangles = 512;
INTEROP_CONST kItemInvocations = 64;

INTEROP_CONST kBindPositions = 0;   // float x3, recentred: pictures and boxes
INTEROP_CONST kBindOriginals = 1;   // float x3, as given: pairs
INTEROP_CONST kBindIndices = 2;     // uint, 3 per triangle
INTEROP_CONST kBindMeshes = 3;      // MeshRecord
INTEROP_CONST kBindObjects = 4;     // ObjectRecord
INTEROP_CONST kBindViews = 5;       // View
INTEROP_CONST kBindDraws = 6;       // Draw
INTEROP_CONST kBindItems = 7;       // Item
INTEROP_CONST kBindCandidates = 8;  // Candidate, kCells per view
INTEROP_CONST kBindRanks = 9;       // uint, kCells per view: which candidate a cell holds, or kNobody
INTEROP_CONST kBindAnswers = 10;    // Answer
INTEROP_CONST kBindRange = 11;      // depth of R, one layer per view
INTEROP_CONST kBindMask = 12;       // depth of M, one layer per view
INTEROP_CONST kBindTriangleIds = 13; // uint: the triangle at a slot of the cluster order
INTEROP_CONST kBindOpenPairs = 14;    // OpenPair, kOpenPairs per view
INTEROP_CONST kBindings = 15;

// The contact tier has a set of its own: the scene's buffers at the numbers above, and these.
INTEROP_CONST kBindNodes = 5;         // ClusterRecord
INTEROP_CONST kBindTargets = 6;       // Target
INTEROP_CONST kBindPlacements = 7;    // Placement
INTEROP_CONST kBindRefs = 8;          // ClusterRef
INTEROP_CONST kBindBoxes = 9;         // RefBox, one per ClusterRef
INTEROP_CONST kBindPairItems = 10;    // PairItem
INTEROP_CONST kBindClusterPairs = 11; // ClusterPair
INTEROP_CONST kBindStates = 12;       // State, one per Target
INTEROP_CONST kBindContenders = 13;   // Contender
INTEROP_CONST kBindTiles = 14;        // uvec2, kTilesPerCluster for each cluster under a mask
INTEROP_CONST kContactBindings = 15;

// Telling has a set of its own, too: those it needs of the contact tier's at the numbers above, and these.
INTEROP_CONST kBindSlotIds = 7;        // uint: the triangle at a slot of the cluster order
INTEROP_CONST kBindResults = 8;        // RadarResult, one per Target
INTEROP_CONST kBindOpenContenders = 9; // OpenCount, then OpenContender

// The mask in contact has a set of its own, too: the contact tier's buffers at the numbers above but for the last four,
// and these.
INTEROP_CONST kBindMaskScopes = 10;   // uint: keys of depth (outer.glsl), the four planes kScope*
INTEROP_CONST kBindMaskItems = 11;    // MaskItem

// So has a host's geometry: the scene's buffers, nodes, placements and results at the numbers above, and these.
INTEROP_CONST kBindWords = 9;         // uint: what was copied from the host's buffers
INTEROP_CONST kBindMoved = 10;        // Moved
INTEROP_CONST kBindStrays = 11;       // Stray

// The bounded tier has the sampled tier's set, but for the depth images.
INTEROP_CONST kBindScopes = 11;       // uint: keys of depth (outer.glsl), the four planes kScope*
INTEROP_CONST kBindBands = 12;        // Band
INTEROP_CONST kBindStrips = 15;       // Strip
INTEROP_CONST kBoundedBindings = 16;

// Triangles of a cluster, at most.
INTEROP_CONST kCluster = 64;
// Sensor clusters of one PairItem, and how many scene clusters each is held against.
INTEROP_CONST kPairItemA = 16;
INTEROP_CONST kPairItemB = 4096;

struct MeshRecord {
  Point centre;      // recentred vertices are relative to it
  Point halfExtent;  // of recentred vertices, at most
  uint firstVertex;
  uint firstIndex;
  uint firstNode;
};

struct ObjectRecord {
  PreciseRows pose;
  uint mesh;
  uint pad;
};

// One sensor. Lengths are world units along the motion from the sensor's back plane, unless said otherwise.
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
  float slack;           // L this far below 0 may be a contact at the start: the rounding of R and M
  float rangeLimit;      // stored R of d: what lies beyond is not in the target volume
  uint firstPixel;       // of its outer scopes, in each plane
};

// One mesh placed in one view: an instance of a depth-only draw. In the bounded tier only what it is counts, for `solve`.
struct Draw {
  float clipFromMesh[12];  // recentred mesh -> normalised device coordinates, w = 1
  float snap;              // how far from a triangle a covered centre may lie, pixels
  float slack;             // rounding of the depth it stores
  uint view;
  uint layer;              // within the render pass
  uint mesh;
  uint object;             // kNobody: the sensor
};

// kItemTriangles triangles of a draw. Items of a view stand in the order of (object, triangle), so that the least
// (item, lane) is the least (object, triangle).
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
  uint itemA;     // and of the sensor's
};

struct Answer {
  double hi;       // upper end of the best solved pair, world units; only if object != kNobody
  uint object;
  uint triB;
  uint triA;
  uint feature;    // what attains hi, see solve.comp
  float minL;      // the paper's min(L)
  uint flags;      // kAnswer*
  uint candidates;
  uint pairs;      // distinct pairs solved
  uint openPairs;
  float lo;        // bounded tier: nothing meets before, pixels; less than 0: no pixel where anything could
};

struct OpenPair {
  double low;  // it does not meet before, world units
  uint object;
  uint triB;
  uint triA;
  uint pad;
};
INTEROP_CONST kAnswerDetected = 1;  // some R < d
INTEROP_CONST kAnswerHasL = 2;      // minL exists

// ---- the bounded tier ---------------------------------------------------------------------------------------------------

// Outer scopes, keys of depth along the motion in pixels (outer.glsl): the sensor's nearest, the scene's nearest, the
// scene's farthest, the sensor's farthest. Where there is none the first two hold kNobody and the others 0.
INTEROP_CONST kScopeS = 0;
INTEROP_CONST kScopeR = 1;
INTEROP_CONST kScopeF = 2;
INTEROP_CONST kScopeM = 3;
// What a dispatch draws: F of the scene; then S and M of the sensor, where not behind F; then R of the scene, where not
// before S.
INTEROP_CONST kDrawFarthest = 1;
INTEROP_CONST kDrawSensor = 2;
INTEROP_CONST kDrawNearest = 3;

// A cluster in the pixels of the window that it may touch, with all that its triangles share.
struct Band {
  Rows pixelsFromMesh;  // recentred mesh -> pixels on all axes, from the window's corner and the frame's origin
  float snap;        // how far a vertex may be off, pixels
  float slack;       // how far a depth may be off
  uint view;
  uint firstPixel;   // of the view, in each plane
  uint pitch;        // pixels from row to row
  uint firstVertex;  // of the mesh
  uint firstIndex;   // of the first triangle
  uint triangles;    // kCluster at most
  uint firstColumn;  // of the window
  uint endColumn;
  uint firstRow;
  uint endRow;
  uint fromRow;      // of those, what is drawn by triangle: bounds do not depend on it
  uint toRow;
  uint item;
  uint isSensor;
};
// Some rows of one view, and the bands that are drawn there.
struct Strip {
  uint firstRow;
  uint endRow;
  uint firstBand;
  uint endBand;
};
// A row of outer scopes begins at a multiple of this.
INTEROP_CONST kPixelGroup = 4;
// Of a strip an invocation has every so many groups of a row.
INTEROP_CONST kGroupStep = 8;
// Pixels of a band that is drawn by triangle, and of a strip, at most. Lavapipe ends loops silently after 65,535 iterations of
// an invocation: each pixel takes two, of kCluster / 8 triangles. Less also keeps a device's invocations evenly busy.
INTEROP_CONST kBandPixels = 2048;

// ---- the contact tier --------------------------------------------------------------------------------------------------

struct ClusterRecord {
  Point centre;  // of recentred vertices
  Point halfExtent;
  Point edge;    // the longest of its triangles'; only of a cluster
  uint first;    // triangle slot
  uint count;    // triangles; 0: not a cluster
};

// One sensor, one search for its first contact.
struct Target {
  PreciseRows pose;
  double direction[3];
  double directionLength;
  double distance;          // D
  uint mesh;
  uint firstPair;           // of ClusterPair
  uint pairCapacity;
  uint firstContender;
  uint contenderCapacity;
  float enough;             // a contact certainly before this ends the search: D, rounded down, where only "within D or
                            // not" is asked; else 0
  float corner[2];          // of the mask's pixels, in the frame
  float pixelsPerUnit;      // of the mask
  uint maskCost;            // what the mask costs, in triangles trimmed; or kNoMask
  uint decides;             // only "within D or not" is asked
  uint result;              // where its answer goes
};
INTEROP_CONST kNoMask = 0xffffffffu;

// A mesh in a sensor's frame: axes across and along the motion, about the sensor's centre, world units.
struct Placement {
  Rows frameFromMesh;       // from recentred vertices
  float error;              // how far a vertex placed by it may be off, world units
  uint mesh;
  uint object;              // kNobody: the sensor
  uint moved;               // where a host moves it: Moved, and until then frameFromMesh is frame from world, about its
                            // anchor, and error what double precision loses; else kNobody
};

struct ClusterRef {
  uint placement;
  uint node;  // of the mesh
};

struct RefBox {
  Point lo;
  Point hi;
  Point edge;  // the cluster's longest
};

struct PairItem {
  uint target;
  uint firstA, endA;  // of ClusterRef: the sensor's
  uint firstB, endB;  // the scene's
};

// Two clusters whose boxes can meet; gap: the least distance between them along the motion. -1: dealt with.
struct ClusterPair {
  float gap;
  uint a;
  uint b;
};

// A pair of triangles that may hold the first contact.
struct Contender {
  double low;     // it does not meet before, world units
  double at;      // of the feature that certainly meets, in multiples of the direction, and how far that may be off;
  double error;   // only if kContenderMeets
  uint object;
  uint slotB;     // triangle slots, in cluster order
  uint slotA;
  uint flags;     // kContender*, and the feature that attains `at` in the low bits
};
INTEROP_CONST kContenderPierces = 0x400;  // certainly meets at the start
INTEROP_CONST kContenderMeets = 0x200;  // certainly, no later than at + error
INTEROP_CONST kContenderSharp = 0x100;  // certainly first at `at`, and nothing of it may come earlier

// A pair that the device cannot decide, for the host: its name, its corners as given, and the object's pose.
struct OpenContender {
  uint target;
  uint object;
  uint triB;
  uint triA;
  Point a[3];
  Point b[3];
  PreciseRows pose;
};
// Contenders of a search, for each lane that tells of it: telling takes an iteration for each.
INTEROP_CONST kMostListed = 60000;
struct OpenCount {
  uint count;  // of all; kept up to the capacity
  uint pad;
};

INTEROP_CONST kSearchDone = 0;
INTEROP_CONST kSearchUnfinished = 1;  // cluster pairs are left: dispatch again
INTEROP_CONST kSearchOverflow = 2;    // more contenders than room: begin again with more
INTEROP_CONST kSearchAsksMask = 3;    // cluster pairs are left that cost more than the mask
INTEROP_CONST kSearchMasked = 4;      // cluster pairs of what the mask leaves are left

struct State {
  float hi;             // first contact is certainly no later, world units; at first D, rounded up
  uint pairCount;       // cluster pairs found, kept up to the capacity
  uint contenderCount;  // likewise
  uint progress;        // kSearch*
  uint boxPairs;        // triangle pairs that reached the box test
  uint solved;          // triangle pairs solved
  uint round;
  uint cursor;          // cluster pairs before this one are dealt with
  uint spent;           // cost of what was done, in triangles trimmed
  uint met;             // cluster pairs that this was for
  uint tiles;           // where its clusters' tiles begin, less its first ClusterRef; only if kSearchMasked
};

// ---- the mask in contact -----------------------------------------------------------------------------------------------

// Pixels of its window, both ways.
INTEROP_CONST kMaskSide = 32;
INTEROP_CONST kMaskPixels = 1024;
// A tile is kTileSide pixels wide; 8 x 8 of them have a bit each. A cluster has the tiles where each of its triangles is
// alive, and last those where any is.
INTEROP_CONST kTileSide = 4;
INTEROP_CONST kTilesPerRow = 8;
INTEROP_CONST kTilesPerCluster = 65;

// What a dispatch draws: F of the scene; S and M of the sensor, where not behind F; R of the scene, where not before S,
// and where its triangles are alive; where the sensor's are.
INTEROP_CONST kMaskFarthest = 1;
INTEROP_CONST kMaskSensor = 2;
INTEROP_CONST kMaskNearest = 3;
INTEROP_CONST kMaskAlive = 4;

// A cluster, drawn by a workgroup.
struct MaskItem {
  uint target;
  uint ref;         // ClusterRef
  uint firstPixel;  // of the target, in each plane
  uint firstOther;  // ClusterRef: the other side's
  uint endOther;
};

// Features: 0..2 vertex i of the sensor's triangle on the other's face; 3..5 vertex i-3 of the scene's triangle on the
// sensor's face; 6 + 3*i + j: edge i of the sensor's triangle and edge j of the scene's, edges being (0,1), (1,2), (0,2).
INTEROP_CONST kFeatureEdges = 6;

// ---- a host's geometry -------------------------------------------------------------------------------------------------

// What three of are a position.
INTEROP_CONST kFloat32 = 0;
INTEROP_CONST kFloat16 = 1;
INTEROP_CONST kSnorm16 = 2;
INTEROP_CONST kUnorm16 = 3;

// What is out of its bounds, or not finite: one vertex, if any, and one object. kNobody: none.
struct Stray {
  uint mesh;
  uint vertex;
  uint object;
};

// An object that a host moves.
struct Moved {
  uint object;
  uint mesh;
  uint firstByte;    // of its transform: 12 floats
  Point anchor;      // of its bounds' middle, world
  Point halfExtent;  // of its bounds about the anchor
};

// ---- the self-test of doubles ------------------------------------------------------------------------------------------

INTEROP_CONST kBindSums = 0;        // Sum
INTEROP_CONST kBindSumResults = 1;  // SumResult
INTEROP_CONST kSumBindings = 2;
INTEROP_CONST kSums = 256;

// Numbers to calculate with: x and y, and p placed by a row of a pose.
struct Sum {
  double x, y;
  double row[4];
  Point p;
  uint pad;
};

struct SumResult {
  double sum, product, quotient, placed, rounded;
};

#ifdef __cplusplus
}  // namespace radar::gpu
#endif
#undef INTEROP_CONST
#endif
