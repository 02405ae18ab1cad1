// Structs of the sampled tier's passes, shared with C++ (engine/sampled).
#ifndef RADAR_SAMPLED_INTEROP_H
#define RADAR_SAMPLED_INTEROP_H

#include "../contact/interop.h"

#ifdef __cplusplus
namespace radar::gpu {
#endif

// The window has 16 x 16 cells; each proposes its pixel of least L. One workgroup reduces one sensor, one invocation
// one cell.
INTEROP_CONST kCellsPerSide = 16;
INTEROP_CONST kCells = 256;
// Maximum number of pairs that a sensor's candidates propose: the first distinct ones, in order of (L, pixel).
INTEROP_CONST kPairsPerView = 64;
// Triangles of one draw per identify workgroup. Each invocation takes several, since loading the draw's matrix costs as
// much as a triangle.
INTEROP_CONST kItemTriangles = 512;
INTEROP_CONST kItemInvocations = 64;

// One sensor. Lengths are in world units along the motion from the sensor's back plane, unless noted otherwise.
struct View {
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
  float start;           // see Sweep
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
  float minL;       // the paper's min(L)
  uint flags;       // kAnswer*
  uint candidates;  // how many, in order of (L, pixel)
};
INTEROP_CONST kAnswerDetected = 1;  // some R < d
INTEROP_CONST kAnswerHasL = 2;      // minL exists

struct IdentifyPush {
  uint items;
};

// Beside those of the contact tier, by which proposed pairs are solved.
INTEROP_SLOT(kSlotViews, 19, View);
INTEROP_SLOT(kSlotDraws, 20, Draw);
INTEROP_SLOT(kSlotItems, 21, Item);
INTEROP_SLOT(kSlotCandidates, 22, Candidate);  // kCells per view
INTEROP_SLOT(kSlotRanks, 24, uint);            // kCells per view: the cell's candidate, or kNobody
INTEROP_SLOT(kSlotAnswers, 25, Answer);
INTEROP_SLOT(kSlotRange, 26, SampledImage);    // depth of R, one layer per view
INTEROP_SLOT(kSlotMask, 27, SampledImage);     // depth of M, one layer per view

#ifdef __cplusplus
}  // namespace radar::gpu
#endif
#endif
