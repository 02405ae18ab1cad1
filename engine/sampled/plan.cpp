#include "sampled/plan.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "contact/search_plan.h"
#include "math/frame.h"
#include "math/rounding.h"
#include "query/swept.h"
#include "sampled/in_frame.h"
#include "scene/placement.h"

namespace radar {

namespace {

// Larger clip coordinates might overflow in products of the identify stage (docs/method.md, "Ranges, infinities and
// rounding"). Units: half the window across, the picture's depth along.
constexpr double kMostAcross = 0x1p40, kMostAlong = 0x1p48;
// Longer distances D, in sensor's sizes, are solved as this one: nothing that is drawn is as far away.
constexpr double kMostScaled = 1e38;
// Largest number of triangles in a cluster: neighbours that are drawn or skipped together.
constexpr uint32_t kClusterTriangles = 64;

// The reason why the scopes cannot be drawn, as far as it is known before the view is set up; else empty.
std::string outOfRange(const Query& query, const Scene::Impl& scene) {
  const Vector direction = scaledDirection(query.direction);
  if (std::ilogb(largest(direction)) != 0) {
    return "range: the direction's components differ too much in size for doubles";
  }
  if (!scene.objectTree().inRange()) return "range: an object has coordinates beyond 2^80";
  if (!isInRange(placementOf(scene.meshes[query.mesh], query.worldFromMesh))) {
    return "range: the sensor has coordinates beyond 2^80, or a size below 2^-80";
  }
  return {};
}

// The greatest coordinate.
double largestOf(const Box& box) {
  return std::max(largest(box.lo), largest(box.hi));
}

// A plan in the making. Boxes are in the view's frame, unless noted otherwise.
class Planner {
 public:
  Planner(const Query& query, const Scene::Impl& scene, uint32_t subPixelBits, Drawn drawn)
      : query_(query),
        scene_(scene),
        sensor_(scene.meshes[query.mesh]),
        subPixel_(std::ldexp(1.0, -static_cast<int>(subPixelBits))),
        drawn_(drawn) {}

  ViewPlan plan();

 private:
  void lookAlong();
  void sweepWindow();
  Box windowInWorld() const;
  void selectObjects();
  void setSweep();
  void setView();
  void setVisible();
  Placed framed(ObjectId object, MeshId mesh, const Transform& worldFromMesh) const;
  void place(Placed& placed, double scaleZ, double offsetZ) const;
  void placeInRange(Placed& placed) const;
  void addWhole(Placed& placed);
  template <class Wanted>
  void addClusters(Placed& placed, const Wanted& wanted);
  void addReached();
  void addOthers();

  const Query& query_;
  const Scene::Impl& scene_;
  const Mesh& sensor_;
  const double subPixel_;
  const Drawn drawn_;
  ViewPlan plan_;
  Vector origin_{};  // of the frame, in world coordinates: the sensor's centre
  Affine frameFromWorld_{};
  Box window_;         // the sensor's extents, widened by `margin_` across
  double margin_ = 0;  // world units
  double size_ = 0;    // of the sensor, its greatest extent
  Box prism_;          // the window, swept
  double depth_ = 0;   // from the back plane to the farthest object in the prism, at most d
  double error_ = 0;   // the greatest placement error of an object in the prism
  Box visible_;        // all that the scopes can show
};

// Sets the frame and the window.
void Planner::lookAlong() {
  plan_.axes = axesAlong(query_.direction);
  origin_ = transform(query_.worldFromMesh, sensor_.origin);
  for (int k = 0; k < 3; ++k) {
    std::copy(plan_.axes[k].begin(), plan_.axes[k].end(), &frameFromWorld_[4 * k]);
    frameFromWorld_[4 * k + 3] = -dot(plan_.axes[k], origin_);
  }
  plan_.mask = framed(kNone, query_.mesh, query_.worldFromMesh);
  const Affine& m = plan_.mask.frameFromMesh;
  window_ = !sensor_.hasBounds && fitsFloats(sensor_, m) ? tightBox(sensor_, m) : turned(sensor_.box, m, 0);
  plan_.length = window_.hi[2] - window_.lo[2];
  plan_.d = plan_.length + query_.distance;
  for (int k = 0; k < 3; ++k) size_ = std::max(size_, window_.hi[k] - window_.lo[k]);
  margin_ = std::max(64 * plan_.mask.error, 1e-5 * size_);
  // A sensor without extent (a point) still gets a window.
  if (margin_ == 0) margin_ = std::max(1e-5 * query_.distance, 1e-30);
  for (int k = 0; k < 2; ++k) {
    window_.lo[k] -= margin_;
    window_.hi[k] += margin_;
  }
}

// The mesh as yet without a draw.
Placed Planner::framed(ObjectId object, MeshId mesh, const Transform& worldFromMesh) const {
  Placed placed;
  placed.draw.object = object;
  placed.draw.mesh = mesh;
  placed.frameFromMesh = frameFromLocal(plan_.axes, origin_, worldFromMesh, scene_.meshes[mesh].origin);
  placed.error = doubleError(scene_.meshes[mesh], worldFromMesh, origin_) +
                 placementError(scene_.meshes[mesh], placed.frameFromMesh);
  return placed;
}

void Planner::sweepWindow() {
  prism_ = window_;
  prism_.hi[2] = window_.lo[2] + plan_.d;
  for (int k = 0; k < 3; ++k) {
    prism_.lo[k] -= plan_.mask.error;
    prism_.hi[k] += plan_.mask.error;
  }
}

// The box in the world around the window, with room for the sensor's placement error and for rounding.
Box Planner::windowInWorld() const {
  Affine worldFromFrame;
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 3; ++i) worldFromFrame[4 * i + k] = plan_.axes[k][i];
    worldFromFrame[4 * k + 3] = origin_[k];
  }
  return turned(window_, worldFromFrame, 2 * plan_.mask.error + 0x1p-45 * (largestOf(window_) + largest(origin_)));
}

// Sets inReach to the objects in the prism, and their depth and error.
void Planner::selectObjects() {
  double farthest = window_.lo[2];
  const Box start = windowInWorld();
  for (const ObjectId id : inReach(query_, scene_, scene_.objectTree(), start)) {
    const Object& object = scene_.objects[id].object;
    const Placed placed = framed(id, object.mesh, object.worldFromMesh);
    Box box = turned(scene_.meshes[object.mesh].box, placed.frameFromMesh, 0);
    if (const Box* bounds = scene_.boundsOf(id)) {
      box.merge(turned(*bounds, frameFromWorld_, 0x1p-47 * (largestOf(*bounds) + largest(origin_))));
    }
    if (!overlap(box, prism_, doubleError(scene_.meshes[object.mesh], object.worldFromMesh, origin_))) continue;
    farthest = std::max(farthest, box.hi[2]);
    error_ = std::max(error_, placed.error);
    plan_.inReach.push_back(placed);
  }
  depth_ = std::min(plan_.d, std::max(farthest - window_.lo[2], 0.0));
}

// The proposed pairs are solved about the sensor's size, up to D.
void Planner::setSweep() {
  const Translation motion(query_);
  plan_.sweep = sweepOf(query_, motion, scene_);
  const int exponent = std::ilogb(std::max(size_, margin_));
  plan_.sweep.scale = static_cast<float>(std::ldexp(1.0, -exponent));
  // No less than what shaders might flush to 0.
  const double distance = std::ldexp(query_.distance, -exponent);
  plan_.sweep.start = plan_.view.start = std::max(roundUp(std::min(distance, kMostScaled)), 1e-37f);
}

void Planner::setView() {
  const double across[2] = {window_.hi[0] - window_.lo[0], window_.hi[1] - window_.lo[1]};
  const double side = std::max(across[0], across[1]), scale = std::cbrt(std::abs(determinant(query_.worldFromMesh)));
  const uint32_t resolution =
      query_.resolution != 0 ? query_.resolution : chooseResolution(side, scale * sensor_.meanEdge);
  plan_.pixel = side / resolution;
  for (int i = 0; i < 3; ++i) {
    plan_.corner[i] = origin_[i];
    for (int k = 0; k < 3; ++k) plan_.corner[i] += plan_.axes[k][i] * window_.lo[k];
  }
  const auto pixels = [&](double length) {
    return std::clamp(static_cast<uint32_t>(std::ceil(length / plan_.pixel)), 1u, resolution);
  };
  // The far plane is a little beyond the depth that must be visible, so that contact exactly at D is not clipped.
  const double rangeScale = depth_ + std::max({64 * kFloatUnit * depth_, 2 * error_, margin_});
  const double maskScale = plan_.length + 2 * margin_;
  setSweep();
  gpu::View& view = plan_.view;
  view.resolution = resolution;
  view.width = pixels(across[0]);
  view.height = pixels(across[1]);
  view.cell = std::max(2u, 2 * ((resolution + 2 * gpu::kCellsPerSide - 1) / (2 * gpu::kCellsPerSide)));
  view.rangeScale = static_cast<float>(rangeScale);
  view.maskBase = static_cast<float>(plan_.length + margin_);
  view.maskScale = static_cast<float>(maskScale);
  view.slack = static_cast<float>(error_ + plan_.mask.error + 4 * kFloatUnit * (rangeScale + maskScale));
  // Stored depths are at most 1.
  view.rangeLimit =
      static_cast<float>(std::min((plan_.d + error_ + plan_.mask.error) / rangeScale + 4 * kFloatUnit, 2.0));
}

// The visible box, without a mesh's own error: whole pixels, which may pass the window's edge, plus twice the distance
// by which snapping and float rounding move a vertex.
void Planner::setVisible() {
  const gpu::View& view = plan_.view;
  const double around = plan_.pixel * 2 * (subPixel_ + 6 * kFloatUnit * view.resolution);
  const double along = 64 * kFloatUnit * view.rangeScale;
  const double width = plan_.pixel * view.width, height = plan_.pixel * view.height;
  const Vector& lo = window_.lo;
  visible_ = {{lo[0] - around, lo[1] - around, lo[2] - along},
              {lo[0] + width + around, lo[1] + height + around, lo[2] + view.rangeScale + along}};
}

// Sets the draw: clip.xy = 2 (frame.xy - corner) / (pixel * resolution) - 1; clip.z = scaleZ * frame.z + offsetZ.
void Planner::place(Placed& placed, double scaleZ, double offsetZ) const {
  const Mesh& mesh = scene_.meshes[placed.draw.mesh];
  const uint32_t resolution = plan_.view.resolution;
  const double snap = subPixel_ + placed.error / plan_.pixel + 6 * kFloatUnit * resolution;
  const double slack = placed.error * std::abs(scaleZ) + 8 * kFloatUnit;
  const double across = 2 / (plan_.pixel * resolution);
  const double scale[3] = {across, across, scaleZ};
  const double offset[3] = {-across * window_.lo[0] - 1, -across * window_.lo[1] - 1, offsetZ};
  Affine clip;
  for (int i = 0; i < 12; ++i) clip[i] = scale[i / 4] * placed.frameFromMesh[i] + (i % 4 == 3 ? offset[i / 4] : 0);
  placed.fits = fitsFloats(mesh, clip) && staysBelow({kMostAcross, kMostAcross, kMostAlong}, mesh, clip, 0) &&
                snap < kMostAcross && slack < kMostAlong;
  if (!placed.fits) return;
  const auto toFloat = [](double x) { return static_cast<float>(x); };
  std::transform(clip.begin(), clip.end(), placed.draw.clipFromMesh, toFloat);
  std::transform(mesh.origin.begin(), mesh.origin.end(), placed.draw.origin, toFloat);
  placed.draw.snap = toFloat(snap);
  placed.draw.slack = toFloat(slack);
}

void Planner::placeInRange(Placed& placed) const {
  const double rangeScale = plan_.view.rangeScale;
  place(placed, 1 / rangeScale, -window_.lo[2] / rangeScale);
}

void Planner::addWhole(Placed& placed) {
  placed.firstRun = static_cast<uint32_t>(plan_.runs.size());
  placed.runs = 1;
  plan_.runs.push_back({0, scene_.meshes[placed.draw.mesh].triangleCount()});
}

// Adds the clusters that are wanted, in the order of their triangles. bool wanted(box, isCluster) must hold for every
// box around a wanted one.
template <class Wanted>
void Planner::addClusters(Placed& placed, const Wanted& wanted) {
  const Mesh& mesh = scene_.meshes[placed.draw.mesh];
  Affine frameFromNormalised = placed.frameFromMesh;
  for (int i = 0; i < 12; ++i) frameFromNormalised[i] *= i % 4 == 3 ? 1 : mesh.unit;
  placed.firstRun = static_cast<uint32_t>(plan_.runs.size());
  thread_local std::vector<uint32_t> open;
  open.assign(1, 0);
  while (!open.empty()) {
    const uint32_t at = open.back();
    open.pop_back();
    const gpu::MeshNode& node = mesh.tree.nodes[at];
    const MeshTree::Below& below = mesh.tree.below[at];
    const bool isCluster = below.count <= kClusterTriangles;
    if (!wanted(turned(node.centre, node.halfExtent, frameFromNormalised, placed.error), isCluster)) continue;
    if (!isCluster) {
      open.insert(open.end(), {node.link + 1, node.link});
      continue;
    }
    const bool follows =
        plan_.runs.size() > placed.firstRun && plan_.runs.back().first + plan_.runs.back().count == below.first;
    if (!follows) plan_.runs.push_back({below.first, 0});
    plan_.runs.back().count += below.count;
  }
  placed.runs = static_cast<uint32_t>(plan_.runs.size()) - placed.firstRun;
}

// Keeps in inReach what is visible, or nothing if no cluster meets the prism, and draws it and `mask`.
void Planner::addReached() {
  bool inPrism = false;
  std::vector<Box> columns;  // around the visible clusters of each object, unbounded along the motion
  if (drawn_ != Drawn::inReach) addWhole(plan_.mask);
  for (Placed& placed : plan_.inReach) {
    placeInRange(placed);
    Box around;
    addClusters(placed, [&](const Box& box, bool isCluster) {
      if (!overlap(box, visible_, 0)) return false;
      if (isCluster) {
        inPrism = inPrism || overlap(box, prism_, 0);
        around.merge(box);
      }
      return true;
    });
    if (placed.runs == 0) continue;
    if (drawn_ == Drawn::everything) {
      plan_.runs.resize(placed.firstRun);
      addWhole(placed);
    }
    around.lo[2] = -1e300;
    around.hi[2] = 1e300;
    columns.push_back(around);
  }
  std::erase_if(plan_.inReach, [&](const Placed& placed) { return !inPrism || placed.runs == 0; });
  if (!inPrism) plan_.runs.resize(plan_.mask.runs);
  if (drawn_ != Drawn::inReach || !inPrism) return;
  // A pixel in both R and M is in a column and in the box of a cluster of the sensor, each widened by the same
  // snapping.
  const double around = window_.lo[0] - visible_.lo[0];
  addClusters(plan_.mask, [&](const Box& box, bool) {
    return std::any_of(columns.begin(), columns.end(), [&](const Box& c) { return overlap(box, c, around); });
  });
}

// Adds objects out of reach. Those that meet the visible box are left out: the scopes reach farther than the prism by a
// rounding error, which must not change the answer.
void Planner::addOthers() {
  const Participants participants(query_, scene_);
  for (ObjectId id = 0; id < scene_.objects.size(); ++id) {
    const Object& object = scene_.objects[id].object;
    if (!scene_.objects[id].used || !participants.contain(id)) continue;
    Placed placed = framed(id, object.mesh, object.worldFromMesh);
    const Box box = turned(scene_.meshes[object.mesh].box, placed.frameFromMesh, 0);
    if (overlap(box, visible_, 2 * placed.error)) continue;
    placeInRange(placed);
    if (!placed.fits) continue;
    addWhole(placed);
    plan_.others.push_back(placed);
  }
}

ViewPlan Planner::plan() {
  lookAlong();
  sweepWindow();
  selectObjects();
  setView();
  setVisible();
  // The scales are those rounded to float, as shaders use them, so that drawing and reading the scopes agree.
  const double maskScale = plan_.view.maskScale, maskBase = plan_.view.maskBase;
  place(plan_.mask, -1 / maskScale, (maskBase + window_.lo[2]) / maskScale);
  addReached();
  const bool fits = std::all_of(plan_.inReach.begin(), plan_.inReach.end(), [](const Placed& p) { return p.fits; });
  if (!plan_.inReach.empty() && !(plan_.mask.fits && fits)) {
    plan_.outOfRange =
        "range: an object in reach is too large relative to the sensor, or placed too imprecisely, for floats";
    return std::move(plan_);
  }
  for (const Run& run : plan_.runs) plan_.items += (run.count + gpu::kItemTriangles - 1) / gpu::kItemTriangles;
  if (drawn_ == Drawn::everything && !plan_.inReach.empty()) addOthers();
  for (const Run& run : plan_.runs) plan_.triangles += run.count;
  return std::move(plan_);
}

}  // namespace

uint32_t chooseResolution(double windowSide, double meanEdge) {
  const double wanted = meanEdge > 0 ? 4 * windowSide / meanEdge : 512;
  return std::bit_ceil(static_cast<uint32_t>(std::clamp(wanted, 64.0, 512.0)));
}

ViewPlan planSampled(const Query& query, const Scene::Impl& scene, uint32_t subPixelBits, Drawn drawn) {
  ViewPlan none;
  none.outOfRange = outOfRange(query, scene);
  return none.outOfRange.empty() ? Planner(query, scene, subPixelBits, drawn).plan() : none;
}

}  // namespace radar
