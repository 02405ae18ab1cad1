// A query becomes a plan: the window and depth range of its view, the objects in reach, and the matrices they are drawn
// with. CPU only; looks at boxes, never at triangle pairs.
#pragma once

#include <string>
#include <vector>

#include "sampled/selection.h"
#include "shaders/interop.h"

namespace radar {

/// Triangles that stand together in a mesh's cluster order.
struct Run {
  uint32_t first, count;
};

/// A mesh in the window: clip coordinates from recentred vertices, for R or M.
struct Placed {
  ObjectId object = kNone;  ///< kNone: the sensor
  MeshId mesh = kNone;
  bool fits = true;  ///< floats hold it; if not, nothing below is told
  std::array<float, 12> clipFromMesh{};
  std::array<float, 3> origin{};    ///< of the mesh's local vertices
  float snap = 0;                   ///< how far from a triangle a covered centre may lie, pixels
  float slack = 0;                  ///< rounding of stored depth
  uint32_t firstRun = 0, runs = 0;  ///< what of it is drawn, ascending: into ViewPlan::runs
};

/// What a view draws. The picture within the window, and so the answer, is the same but for pixels of M where R is
/// empty.
enum class Drawn {
  everything,  ///< every object, whole: the naive baseline
  wholeMask,   ///< clusters in reach, and the sensor whole: M as a picture
  inReach      ///< clusters in reach, and of the sensor those that pass over them
};

/// Everything a submission needs to know of one query.
struct ViewPlan {
  gpu::View view{};             ///< all but `layer`
  Placed mask;                  ///< the sensor, from the far end
  std::vector<Placed> inReach;  ///< by object; empty: certainly clear
  std::vector<Placed> others;   ///< drawn too, only for Drawn::everything
  std::vector<Run> runs;        ///< of all that is drawn
  std::string outOfRange;       ///< why floats cannot hold the view: then nothing else counts; empty: they can
  uint64_t triangles = 0;       ///< drawn, R and M
  uint64_t items = 0;           ///< what the identify stage takes them in, without the others'

  std::array<Vector, 3> axes{};
  Vector corner{};  ///< world position of the window's lower left corner at the back plane
  double pixel = 0, length = 0, d = 0;
};

/// `subPixelBits`: of the device.
ViewPlan planSampled(const Query& query, const Scene::Impl& scene, uint32_t subPixelBits, Drawn drawn);

/// The window's longer side, pixels, where the query leaves it open: four pixels to the sensor's mean triangle edge, so
/// that a triangle is seen by some pixel centres, in powers of two from 64 to 512.
uint32_t chooseResolution(double windowSide, double meanEdge);

}  // namespace radar
