#include "scene/hierarchy.h"

#include <algorithm>
#include <cmath>

namespace radar {

namespace {

// Fewer boxes in a leaf cost more nodes, more cost more tests; flat between 2 and 8 for 30,000 boxes.
constexpr uint32_t kLeaf = 4;
// Refitting keeps a tree as long as its boxes are not twice as large as when it was built.
constexpr double kRebuildAt = 2.0;
// A few dozen roundings, with room; relative.
constexpr double kRounding = 0x1p-45;

double halfArea(const Box& b) {
  const double x = b.hi[0] - b.lo[0], y = b.hi[1] - b.lo[1], z = b.hi[2] - b.lo[2];
  return x * y + y * z + z * x;
}

double middle(const Box& b, int axis) {
  return 0.5 * (b.lo[axis] + b.hi[axis]);
}

// Separating axes: the world's and the prism's own. The cross products are left out: objects have tighter tests of
// their own behind this one.
bool meets(const Box& b, const Prism& prism, const Box& prismInWorld, double slack) {
  for (int k = 0; k < 3; ++k) {
    if (b.lo[k] > prismInWorld.hi[k] || b.hi[k] < prismInWorld.lo[k]) return false;
  }
  std::array<double, 3> centre, half;
  double own = slack;
  for (int k = 0; k < 3; ++k) {
    centre[k] = 0.5 * (b.lo[k] + b.hi[k]) - prism.origin[k];
    half[k] = 0.5 * (b.hi[k] - b.lo[k]);
    own += kRounding * (std::abs(centre[k]) + half[k]);
  }
  for (int k = 0; k < 3; ++k) {
    const std::array<double, 3>& axis = prism.axes[k];
    const double at = axis[0] * centre[0] + axis[1] * centre[1] + axis[2] * centre[2];
    const double reach = std::abs(axis[0]) * half[0] + std::abs(axis[1]) * half[1] + std::abs(axis[2]) * half[2] + own;
    if (at - reach > prism.box.hi[k] || at + reach < prism.box.lo[k]) return false;
  }
  return true;
}

}  // namespace

void Hierarchy::update(const Scene::Impl& scene) {
  if (seenScene_ != scene.identity) {
    seenScene_ = scene.identity;
    seenStructure_ = seenPose_ = 0;
    objects_.clear();
    nodes_.clear();
  }
  if (seenPose_ == scene.poseVersion) return;
  boxes_.resize(scene.objects.size());
  for (size_t i = 0; i < boxes_.size(); ++i) {
    if (!scene.objects[i].used || scene.changedAt[i] <= seenPose_) continue;
    const Object& object = scene.objects[i].object;
    boxes_[i] = boxOf(scene.meshes[object.mesh], object.worldFromMesh.m);
    if (const Box* bounds = scene.boundsOf(static_cast<ObjectId>(i))) boxes_[i].merge(*bounds);
  }
  const bool sameObjects = seenStructure_ == scene.structureVersion;
  if (sameObjects) refit();
  if (!sameObjects || cost() > kRebuildAt * builtCost_) build(scene);
  seenStructure_ = scene.structureVersion;
  seenPose_ = scene.poseVersion;
}

void Hierarchy::build(const Scene::Impl& scene) {
  objects_.clear();
  for (uint32_t i = 0; i < scene.objects.size(); ++i) {
    if (scene.objects[i].used) objects_.push_back(i);
  }
  nodes_.assign(1, {});
  if (!objects_.empty()) split(0, 0, static_cast<uint32_t>(objects_.size()));
  builtCost_ = cost();
}

// At the median along the axis in which the middles spread most.
void Hierarchy::split(uint32_t node, uint32_t first, uint32_t count) {
  Box box, middles;
  for (uint32_t i = first; i < first + count; ++i) {
    const Box& b = boxes_[objects_[i]];
    box.merge(b);
    middles.add({middle(b, 0), middle(b, 1), middle(b, 2)});
  }
  nodes_[node] = {box, first, count};
  if (count <= kLeaf) return;
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (middles.hi[k] - middles.lo[k] > middles.hi[axis] - middles.lo[axis]) axis = k;
  }
  const uint32_t half = count / 2;
  std::nth_element(objects_.begin() + first, objects_.begin() + first + half, objects_.begin() + first + count,
                   [&](ObjectId a, ObjectId b) { return middle(boxes_[a], axis) < middle(boxes_[b], axis); });
  const auto children = static_cast<uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node].first = children;
  nodes_[node].count = 0;
  split(children, first, half);
  split(children + 1, first + half, count - half);
}

void Hierarchy::refit() {
  for (size_t i = nodes_.size(); i-- > 0;) {  // children stand behind their parents
    Node& node = nodes_[i];
    node.box = {};
    if (node.count == 0 && !objects_.empty()) {
      node.box.merge(nodes_[node.first].box);
      node.box.merge(nodes_[node.first + 1].box);
    }
    for (uint32_t k = 0; k < node.count; ++k) node.box.merge(boxes_[objects_[node.first + k]]);
  }
}

double Hierarchy::cost() const {
  double sum = 0;
  for (const Node& node : nodes_) sum += objects_.empty() ? 0 : halfArea(node.box);
  return sum;
}

void Hierarchy::collect(const Prism& prism, std::vector<ObjectId>& out) const {
  if (objects_.empty()) return;
  Box world;
  double magnitude = 0;
  for (int corner = 0; corner < 8; ++corner) {
    std::array<double, 3> p = prism.origin;
    for (int k = 0; k < 3; ++k) {
      const double at = (corner >> k & 1) != 0 ? prism.box.hi[k] : prism.box.lo[k];
      for (int i = 0; i < 3; ++i) p[i] += prism.axes[k][i] * at;
    }
    world.add(p);
  }
  for (int k = 0; k < 3; ++k) {
    magnitude = std::max({magnitude, std::abs(prism.origin[k]), std::abs(world.lo[k]), std::abs(world.hi[k])});
  }
  const double slack = kRounding * magnitude;
  for (int k = 0; k < 3; ++k) {
    world.lo[k] -= slack;
    world.hi[k] += slack;
  }
  uint32_t stack[64];
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const Node& node = nodes_[stack[--depth]];
    if (!meets(node.box, prism, world, slack)) continue;
    if (node.count == 0) {
      stack[depth++] = node.first;
      stack[depth++] = node.first + 1;
      continue;
    }
    for (uint32_t i = 0; i < node.count; ++i) {
      const ObjectId object = objects_[node.first + i];
      if (meets(boxes_[object], prism, world, slack)) out.push_back(object);
    }
  }
}

}  // namespace radar
