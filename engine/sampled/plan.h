// Plans a query: the window and depth range of its view, the objects in reach, and the matrices to draw them with. CPU
// only; tests boxes, never triangle pairs.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"
#include "shaders/contact/interop.h"
#include "shaders/sampled/interop.h"

namespace radar {

/// Consecutive triangles in a mesh's cluster order.
struct Run {
  uint32_t first, count;
};

/// A mesh in the window, for R or M.
struct Placed {
  gpu::Draw draw{};                 ///< all but `view` and `layer`, if floats can hold it
  bool fits = true;                 ///< floats can hold it; if not, only the draw's mesh and object are set
  Affine frameFromMesh{};           ///< from recentred vertices
  double error = 0;                 ///< bound on the error of a vertex placed by a shader, world units
  uint32_t firstRun = 0, runs = 0;  ///< the runs drawn, ascending, in ViewPlan::runs
};

/// The meshes that a view draws. Scopes differ only in pixels of M where R is empty; answers are the same.
enum class Drawn {
  everything,  ///< every object, whole: the naive baseline
  wholeMask,   ///< clusters in reach, and the whole sensor: shows all of M
  inReach      ///< clusters in reach, and those of the sensor that pass over them
};

/// A submission's data for one query.
struct ViewPlan {
  gpu::View view{};             ///< all but `layer`
  gpu::Sweep sweep{};           ///< all but `result`
  Placed mask;                  ///< the sensor, from the far end
  std::vector<Placed> inReach;  ///< in order of objects; empty: certainly clear
  std::vector<Placed> others;   ///< also drawn, only for Drawn::everything
  std::vector<Run> runs;        ///< of everything drawn
  std::string outOfRange;       ///< why floats cannot hold the view: then the rest is invalid; empty if they can
  uint64_t triangles = 0;       ///< drawn, R and M
  uint64_t items = 0;           ///< number of gpu::Item, without `others`

  std::array<Vector, 3> axes{};  ///< of the view's frame, in world coordinates; the last along the motion
  Vector corner{};               ///< world position of the window's lower left corner at the back plane
  double pixel = 0, length = 0, d = 0;
};

/// `subPixelBits`: the device's subpixel precision.
ViewPlan planSampled(const Query& query, const Scene::Impl& scene, uint32_t subPixelBits, Drawn drawn);

/// The window's longer side, pixels, if the query does not set it: four pixels to the sensor's mean triangle edge, so
/// that some pixel centres see each triangle, in powers of two from 64 to 512.
uint32_t chooseResolution(double windowSide, double meanEdge);

}  // namespace radar
