#include "scene/object_tree.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "math/rounding.h"
#include "scene/box_tree.h"
#include "scene/parallel.h"
#include "scene/scene.h"

namespace radar {

namespace {

// The tree is rebuilt once refitting has made its cost this many times that after the last build.
constexpr double kRebuildAt = 2.0;
constexpr size_t kChunk = 8192;
constexpr size_t kAhead = 16;  // objects
// Objects of a subtree that is refitted on one core.
constexpr uint32_t kSubtree = 1u << 13;

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

// A NaN is out of range, too.
bool isInRange(const Box& box) {
  bool isInside = true;
  for (int k = 0; k < 3; ++k) isInside = isInside && box.lo[k] >= -kMostCoordinate && box.hi[k] <= kMostCoordinate;
  return isInside;
}

}  // namespace

Box objectBox(const Scene::Impl& scene, ObjectId id) {
  const Object& object = scene.objects[id].object;
  Box box = boxOf(scene.meshes[object.mesh], object.worldFromMesh.m);
  sweep(box, object.motion);
  if (const Box* bounds = scene.boundsOf(id)) box.merge(*bounds);
  return box;
}

void ObjectTree::update(const Scene::Impl& scene, const ObjectChanges& changes) {
  if (seenPose_ == scene.poseVersion) return;
  next_ = scene.poseVersion;
  bool isDone = !nodes_.empty() && !changes.areMany;
  if (isDone) {
    leaves_.resize(scene.objects.size(), kNone);
    for (const ObjectId object : changes.objects) apply(scene, object);
    isDone = inRange_ && !isWorn();
  }
  if (!isDone) updateAll(scene);
  seenStructure_ = scene.structureVersion;
  seenPose_ = version_ = scene.poseVersion;
}

bool ObjectTree::isWorn() const {
  return nodes_.empty() || 4 * edits_ > nodes_.size() || !(cost_ <= kRebuildAt * builtCost_);
}

void ObjectTree::updateAll(const Scene::Impl& scene) {
  const bool sameObjects = seenStructure_ == scene.structureVersion;
  leaves_.resize(scene.objects.size(), kNone);
  std::mutex merging;
  world_ = {};
  inRange_ = true;
  parallelFor(leaves_.size(), kChunk, 0, [&](unsigned, size_t first, size_t last) {
    const Around around = fitLeaves(scene, first, last, sameObjects && !nodes_.empty());
    const std::lock_guard lock(merging);
    world_.merge(around.box);
    inRange_ = inRange_ && around.inRange;
  });
  if (sameObjects) refit();
  if (!sameObjects || isWorn()) build(scene);
  changed_.resize(nodes_.size());
  changed_.markAll(next_);
}

// Looks at a range of objects. `fits`: their leaves are fitted, too.
ObjectTree::Around ObjectTree::fitLeaves(const Scene::Impl& scene, size_t first, size_t last, bool fits) {
  Around around;
  for (size_t i = first; i < last; ++i) {
    // The leaves of neighbouring objects are far apart in memory.
    const uint32_t ahead = leaves_[std::min(i + kAhead, leaves_.size() - 1)];
    if (ahead < nodes_.size()) __builtin_prefetch(&nodes_[ahead], 1);
    if (!scene.objects[i].used) continue;
    const Box box = objectBox(scene, static_cast<ObjectId>(i));
    around.box.merge(box);
    around.inRange = around.inRange && isInRange(box);
    if (!fits || leaves_[i] == kNone || scene.changedAt[i] <= seenPose_) continue;
    gpu::ObjectNode& leaf = nodes_[leaves_[i]];
    fitBox(floatBox(box, anchor_), leaf.centre, leaf.halfExtent);
  }
  return around;
}

void ObjectTree::apply(const Scene::Impl& scene, ObjectId object) {
  if (!scene.objects[object].used) {
    if (leaves_[object] != kNone) remove(object);
    return;
  }
  const Box box = objectBox(scene, object);
  inRange_ = inRange_ && isInRange(box);
  if (!inRange_) return;
  world_.merge(box);
  if (leaves_[object] == kNone) {
    insert(object, box);
  } else {
    fit(leaves_[object], box);
    fitUpwards(parents_[leaves_[object]]);
  }
}

void ObjectTree::insert(ObjectId object, const Box& world) {
  if (nodes_.empty()) return;  // all others were removed before: it is built anew
  structure_ = next_;
  const FloatBox box = floatBox(world, anchor_);
  const auto grown = [&](uint32_t node) {
    gpu::ObjectNode both{};
    const FloatBox sum = around(boxAround(nodes_[node]), box);
    fitBox(sum, both.centre, both.halfExtent);
    return halfArea(both) - halfArea(nodes_[node]);
  };
  uint32_t at = 0, level = 1;
  for (; (nodes_[at].link & gpu::kLinkLeaf) == 0; ++level) {
    const uint32_t left = nodes_[at].link;
    at = grown(left) <= grown(left + 1) ? left : left + 1;
  }
  // The leaf makes room for itself and the new one.
  const auto first = static_cast<uint32_t>(nodes_.size());
  nodes_.push_back(nodes_[at]);
  cost_ += halfArea(nodes_[at]);
  nodes_.push_back({.link = gpu::kLinkLeaf | object});
  parents_.resize(nodes_.size(), at);
  changed_.resize(nodes_.size());
  touch(first);
  fit(first + 1, world);
  nodes_[at].link = first;
  touch(at);
  adopt(first);
  adopt(first + 1);
  fitUpwards(at);
  depth_ = std::max(depth_, level + 1);
  ++edits_;
}

void ObjectTree::remove(ObjectId object) {
  const uint32_t leaf = std::exchange(leaves_[object], kNone);
  const uint32_t parent = parents_[leaf];
  structure_ = next_;
  if (parent == kNone) {
    nodes_.clear();
    return;
  }
  // The sibling takes the parent's place.
  const uint32_t left = nodes_[parent].link, sibling = left + (leaf == left ? 1 : 0);
  cost_ -= halfArea(nodes_[leaf]) + halfArea(nodes_[parent]);
  nodes_[parent] = nodes_[sibling];
  touch(parent);
  adopt(parent);
  fitUpwards(parents_[parent]);
  ++edits_;
}

// Fits a leaf.
void ObjectTree::fit(uint32_t node, const Box& box) {
  const FloatBox rounded = floatBox(box, anchor_);
  cost_ -= halfArea(nodes_[node]);
  fitBox(rounded, nodes_[node].centre, nodes_[node].halfExtent);
  touch(node);
  cost_ += halfArea(nodes_[node]);
}

// Fits an inner node, and those above as far as that changes them.
void ObjectTree::fitUpwards(uint32_t node) {
  for (; node != kNone; node = parents_[node]) {
    const uint32_t left = nodes_[node].link;
    const FloatBox box = around(boxAround(nodes_[left]), boxAround(nodes_[left + 1]));
    const gpu::ObjectNode before = nodes_[node];
    fitBox(box, nodes_[node].centre, nodes_[node].halfExtent);
    if (std::ranges::equal(before.centre, nodes_[node].centre) &&
        std::ranges::equal(before.halfExtent, nodes_[node].halfExtent)) {
      return;
    }
    touch(node);
    cost_ += halfArea(nodes_[node]) - halfArea(before);
  }
}

// Tells the object or the children of a node where it is.
void ObjectTree::adopt(uint32_t node) {
  const uint32_t link = nodes_[node].link;
  if ((link & gpu::kLinkLeaf) != 0) {
    leaves_[link & gpu::kLinkItem] = node;
  } else {
    parents_[link] = parents_[link + 1] = node;
  }
}

void ObjectTree::build(const Scene::Impl& scene) {
  std::vector<ObjectId> ids;
  for (uint32_t i = 0; i < scene.objects.size(); ++i) {
    if (scene.objects[i].used) ids.push_back(i);
  }
  structure_ = next_;
  nodes_.clear();
  leaves_.assign(scene.objects.size(), kNone);
  depth_ = 0;
  builtCost_ = cost_ = 0;
  edits_ = 0;
  if (ids.empty() || !inRange_) return;
  for (int k = 0; k < 3; ++k) anchor_[k] = world_.middle(k);
  UnwrittenVector<BoxedItem> items(ids.size());
  parallelFor(ids.size(), kChunk, 0, [&](unsigned, size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) items[i] = {floatBox(objectBox(scene, ids[i]), anchor_), ids[i]};
  });
  const BoxTree tree = buildBoxTree(items, 1);
  nodes_.resize(tree.nodes.size());
  parents_.assign(nodes_.size(), kNone);
  UnwrittenVector<FloatBox> boxes(nodes_.size());
  for (size_t i = nodes_.size(); i-- > 0;) {
    const BoxTree::Node& from = tree.nodes[i];
    boxes[i] = from.child == 0 ? items[from.first].box() : around(boxes[from.child], boxes[from.child + 1]);
  }
  parallelFor(nodes_.size(), kChunk, 0, [&](unsigned, size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      const BoxTree::Node& from = tree.nodes[i];
      nodes_[i] = {.link = from.child != 0 ? from.child : gpu::kLinkLeaf | items[from.first].index()};
      fitBox(boxes[i], nodes_[i].centre, nodes_[i].halfExtent);
      adopt(static_cast<uint32_t>(i));
    }
  });
  listSubtrees(tree);
  depth_ = tree.depth;
  builtCost_ = cost_ = cost();
}

// Divides the tree: the nodes below one are consecutive (box_tree.h).
void ObjectTree::listSubtrees(const BoxTree& tree) {
  builtNodes_ = tree.nodes.size();
  subtrees_.clear();
  topNodes_.assign(1, 0);
  for (size_t i = 0; i < topNodes_.size(); ++i) {
    const BoxTree::Node& node = tree.nodes[topNodes_[i]];
    if (node.child == 0) continue;
    if (node.count <= kSubtree) {
      subtrees_.push_back({node.child, node.child + 2 * node.count - 2});
    } else {
      topNodes_.push_back(node.child);
      topNodes_.push_back(node.child + 1);
    }
  }
}

// Fits the inner nodes, children before their parents: those that edits have added, then those of large subtrees, on
// all cores, then those above. Nodes left over from removed objects are fitted, too, and count.
void ObjectTree::refit() {
  if (!inRange_) nodes_.clear();
  cost_ = 0;
  if (nodes_.empty()) return;
  const auto fitInner = [&](size_t i) {
    gpu::ObjectNode& node = nodes_[i];
    if ((node.link & gpu::kLinkLeaf) == 0) {
      fitBox(around(boxAround(nodes_[node.link]), boxAround(nodes_[node.link + 1])), node.centre, node.halfExtent);
    }
    return halfArea(node);
  };
  const auto fitRange = [&](size_t first, size_t last) {
    double cost = 0;
    for (size_t i = last; i-- > first;) cost += fitInner(i);
    return cost;
  };
  cost_ += fitRange(builtNodes_, nodes_.size());
  std::vector<double> costs(subtrees_.size());
  parallelFor(subtrees_.size(), 1, 0, [&](unsigned, size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) costs[i] = fitRange(subtrees_[i].first, subtrees_[i].last);
  });
  for (const double cost : costs) cost_ += cost;
  for (size_t i = topNodes_.size(); i-- > 0;) cost_ += fitInner(topNodes_[i]);
}

double ObjectTree::cost() const {
  double sum = 0;
  for (const gpu::ObjectNode& node : nodes_) sum += halfArea(node);
  return sum;
}

}  // namespace radar
