#include "scene/object_tree.h"

#include <cmath>

#include "math/rounding.h"
#include "scene/box_tree.h"
#include "scene/parallel.h"
#include "scene/scene.h"

namespace radar {

namespace {

// The tree is rebuilt once refitting has made its cost this many times that after the last build.
constexpr double kRebuildAt = 2.0;
constexpr size_t kChunk = 8192;

double halfArea(const gpu::ObjectNode& node) {
  const double x = node.halfExtent[0], y = node.halfExtent[1], z = node.halfExtent[2];
  return x * y + y * z + z * x;
}

FloatBox floatBox(const Box& box, const Vector& anchor) {
  FloatBox out;
  for (int k = 0; k < 3; ++k) {
    // Covers the rounding of the differences.
    const double lo = box.lo[k] - anchor[k], hi = box.hi[k] - anchor[k];
    out.lo[k] = roundDown(lo - 0x1p-52 * std::abs(lo));
    out.hi[k] = roundUp(hi + 0x1p-52 * std::abs(hi));
  }
  return out;
}

// Extends a box by all its places during a motion.
void sweep(Box& box, const Vector& motion) {
  for (int k = 0; k < 3; ++k) {
    const double room = 0x1p-50 * std::abs(motion[k]);
    if (motion[k] < 0) box.lo[k] += motion[k] - room;
    if (motion[k] > 0) box.hi[k] += motion[k] + room;
  }
}

FloatBox boxAround(const gpu::ObjectNode& node) {
  FloatBox box;
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = roundDown(double(node.centre[k]) - node.halfExtent[k]);
    box.hi[k] = roundUp(double(node.centre[k]) + node.halfExtent[k]);
  }
  return box;
}

}  // namespace

void ObjectTree::update(const Scene::Impl& scene) {
  if (seenPose_ == scene.poseVersion) return;
  boxes_.resize(scene.objects.size());
  parallelFor(boxes_.size(), kChunk, 0, [&](unsigned, size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      if (!scene.objects[i].used || scene.changedAt[i] <= seenPose_) continue;
      const Object& object = scene.objects[i].object;
      boxes_[i] = radar::boxOf(scene.meshes[object.mesh], object.worldFromMesh.m);
      sweep(boxes_[i], object.motion);
      if (const Box* bounds = scene.boundsOf(static_cast<ObjectId>(i))) boxes_[i].merge(*bounds);
    }
  });
  world_ = {};
  inRange_ = true;
  for (size_t i = 0; i < boxes_.size(); ++i) {
    if (!scene.objects[i].used) continue;
    world_.merge(boxes_[i]);
    // A NaN makes the tree out of range, too.
    for (int k = 0; k < 3; ++k) {
      inRange_ = inRange_ && boxes_[i].lo[k] >= -kMostCoordinate && boxes_[i].hi[k] <= kMostCoordinate;
    }
  }
  const bool sameObjects = seenStructure_ == scene.structureVersion;
  if (sameObjects) refit();
  if (!sameObjects || nodes_.empty() || !(cost() <= kRebuildAt * builtCost_)) build(scene);
  seenStructure_ = scene.structureVersion;
  seenPose_ = version_ = scene.poseVersion;
}

void ObjectTree::build(const Scene::Impl& scene) {
  std::vector<ObjectId> ids;
  for (uint32_t i = 0; i < scene.objects.size(); ++i) {
    if (scene.objects[i].used) ids.push_back(i);
  }
  nodes_.clear();
  depth_ = 0;
  builtCost_ = 0;
  if (ids.empty() || !inRange_) return;
  for (int k = 0; k < 3; ++k) anchor_[k] = world_.middle(k);
  std::vector<FloatBox> boxes(ids.size());
  for (size_t i = 0; i < ids.size(); ++i) boxes[i] = floatBox(boxes_[ids[i]], anchor_);
  const BoxTree tree = buildBoxTree(boxes, 1);
  nodes_.resize(tree.nodes.size());
  for (size_t i = 0; i < nodes_.size(); ++i) {
    const BoxTree::Node& from = tree.nodes[i];
    fitBox(from.box.lo, from.box.hi, nodes_[i].centre, nodes_[i].halfExtent);
    nodes_[i].link = from.child != 0 ? from.child : gpu::kLinkLeaf | ids[tree.order[from.first]];
  }
  depth_ = tree.depth;
  builtCost_ = cost();
}

void ObjectTree::refit() {
  if (!inRange_) nodes_.clear();
  for (size_t i = nodes_.size(); i-- > 0;) {  // children come after their parents
    gpu::ObjectNode& node = nodes_[i];
    FloatBox box;
    if ((node.link & gpu::kLinkLeaf) != 0) {
      box = floatBox(boxes_[node.link & gpu::kLinkItem], anchor_);
    } else {
      box = boxAround(nodes_[node.link]);
      const FloatBox other = boxAround(nodes_[node.link + 1]);
      for (int k = 0; k < 3; ++k) {
        box.lo[k] = std::min(box.lo[k], other.lo[k]);
        box.hi[k] = std::max(box.hi[k], other.hi[k]);
      }
    }
    fitBox(box.lo, box.hi, node.centre, node.halfExtent);
  }
}

double ObjectTree::cost() const {
  double sum = 0;
  for (const gpu::ObjectNode& node : nodes_) sum += halfArea(node);
  return sum;
}

}  // namespace radar
