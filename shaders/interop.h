// What both languages must agree on: structs, sentinels, group sizes, binding numbers. Compiled by C++ and by GLSL
// (scalar layout); tests/unit compares the offsets.
#ifndef RADAR_INTEROP_H
#define RADAR_INTEROP_H

#ifdef __cplusplus
#include <cstdint>
namespace radar::gpu {
using uint = uint32_t;
#define INTEROP_CONST inline constexpr uint
#else
#define INTEROP_CONST const uint
#endif

INTEROP_CONST kNobody = 0xffffffffu;

// The window is cut into 16 x 16 cells; each nominates the pixel of its least L. One workgroup reduces one sensor, one
// invocation a cell.
INTEROP_CONST kCellsPerSide = 16;
INTEROP_CONST kCells = 256;
// Candidates are identified and solved in the order of (L, pixel), kRound at a time, until one meets.
INTEROP_CONST kRound = 64;
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
INTEROP_CONST kBindings = 13;

struct MeshRecord {
  uint firstVertex;
  uint firstIndex;
};

struct ObjectRecord {
  double pose[12];
  uint mesh;
  uint pad;
};

// One sensor. Lengths are world units along the motion from the sensor's back plane, unless said otherwise.
struct View {
  double pose[12];
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
  float snap;            // how far from a triangle a covered centre may lie, pixels
  float rangeSlack;      // rounding of stored R
  float maskSlack;       // rounding of stored M
  uint pad;
};

// One mesh placed in one view: an instance of a depth-only draw.
struct Draw {
  float clipFromMesh[12];  // recentred mesh -> normalised device coordinates, w = 1
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
};
INTEROP_CONST kAnswerDetected = 1;  // some R < d
INTEROP_CONST kAnswerHasL = 2;      // minL exists

// Features: 0..2 vertex i of the sensor's triangle on the other's face; 3..5 vertex i-3 of the scene's triangle on the
// sensor's face; 6 + 3*i + j: edge i (from vertex i to i+1) of the sensor's triangle and edge j of the scene's.
INTEROP_CONST kFeatureEdges = 6;
INTEROP_CONST kFeatures = 15;

#ifdef __cplusplus
}  // namespace radar::gpu
#endif
#undef INTEROP_CONST
#endif
