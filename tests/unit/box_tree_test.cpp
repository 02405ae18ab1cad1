// The tree over boxes: every box is in one leaf, and several threads make the same tree as one.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "scene/box_tree.h"
#include "support/catch.h"
#include "workloads/random.h"

namespace {

using namespace radar;
using tools::Random;

FloatBox boxAt(const std::array<double, 3>& middle, const std::array<double, 3>& half) {
  FloatBox box;
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = static_cast<float>(middle[k] - half[k]);
    box.hi[k] = static_cast<float>(middle[k] + half[k]);
  }
  return box;
}

std::vector<FloatBox> randomBoxes(size_t count, uint64_t seed) {
  Random random(seed);
  std::vector<FloatBox> boxes;
  for (size_t i = 0; i < count; ++i) {
    boxes.push_back(boxAt(random.inBox({-100, -100, -1}, {100, 100, 1}), random.inBox({0, 0, 0}, {1, 2, 0.1})));
  }
  return boxes;
}

std::vector<BoxedItem> itemsOf(const std::vector<FloatBox>& boxes) {
  std::vector<BoxedItem> items;
  for (const FloatBox& box : boxes) items.push_back({box, static_cast<uint32_t>(items.size())});
  return items;
}

// Builds a tree and checks what holds for every tree.
class CheckedTree {
 public:
  CheckedTree(const std::vector<FloatBox>& boxes, uint32_t leafSize, bool alone = false)
      : leafSize_(leafSize), items_(itemsOf(boxes)), tree_(buildBoxTree(items_, leafSize, alone)) {
    std::vector<bool> seen(boxes.size());
    for (const BoxedItem& item : items_) {
      REQUIRE(item.index() < boxes.size());
      REQUIRE_FALSE(seen[item.index()]);
      REQUIRE(item.box().lo == boxes[item.index()].lo);
      REQUIRE(item.box().hi == boxes[item.index()].hi);
      seen[item.index()] = true;
    }
    REQUIRE(tree_.nodes[0].first == 0);
    REQUIRE(tree_.nodes[0].count == boxes.size());
    walk();
    CHECK(depth_ == tree_.depth);
    CHECK(visited_ == tree_.nodes.size());
  }
  const BoxTree& tree() const { return tree_; }
  FloatBox boxOf(uint32_t node) const {
    const auto& [first, count, child] = tree_.nodes[node];
    FloatBox box = items_[first].box();
    for (uint32_t i = first; i < first + count; ++i) box = around(items_[i].box(), box);
    return box;
  }
  bool operator==(const CheckedTree& other) const {
    const auto &p = tree_.nodes, &q = other.tree_.nodes;
    return tree_.depth == other.tree_.depth && p.size() == q.size() &&
           std::memcmp(p.data(), q.data(), p.size() * sizeof(p[0])) == 0 &&
           std::equal(items_.begin(), items_.end(), other.items_.begin(), other.items_.end(),
                      [](const BoxedItem& a, const BoxedItem& b) { return a.index() == b.index(); });
  }

 private:
  struct Pending {
    uint32_t node, depth;
  };

  void walk() {
    std::vector<Pending> pending{{0, 1}};
    while (!pending.empty()) {
      const Pending next = pending.back();
      pending.pop_back();
      ++visited_;
      depth_ = std::max(depth_, next.depth);
      const BoxTree::Node& node = tree_.nodes[next.node];
      if (node.count == 0) FAIL("node " << next.node << " is empty");
      if (node.child == 0) {
        if (node.count > leafSize_) FAIL("leaf " << next.node << " holds " << node.count);
        continue;
      }
      const BoxTree::Node &left = tree_.nodes.at(node.child), &right = tree_.nodes.at(node.child + 1);
      if (node.child <= next.node) FAIL("the children of node " << next.node << " stand before it");
      if (left.first != node.first || right.first != left.first + left.count ||
          left.count + right.count != node.count) {
        FAIL("the children of node " << next.node << " do not share its items");
      }
      pending.push_back({node.child, next.depth + 1});
      pending.push_back({node.child + 1, next.depth + 1});
    }
  }

  uint32_t leafSize_, depth_ = 0;
  size_t visited_ = 0;
  std::vector<BoxedItem> items_;
  BoxTree tree_;
};

}  // namespace

TEST_CASE("every box is in one leaf") {
  const uint32_t leafSize = GENERATE(1u, 2u, 5u);
  for (const size_t count : {1u, 2u, 3u, 63u, 64u, 65u, 1234u}) {
    CAPTURE(leafSize, count);
    const std::vector<FloatBox> boxes = randomBoxes(count, count);
    const CheckedTree checked(boxes, leafSize);
    CHECK(checked.tree().nodes.size() <= 2 * count - 1);
    CHECK(checked.tree().depth <= 1 + 3 * std::log2(double(count)));
  }
}

TEST_CASE("a tree over no boxes has no nodes") {
  const BoxTree tree = buildBoxTree({}, 2);
  CHECK(tree.nodes.empty());
  CHECK(tree.depth == 0);
}

TEST_CASE("boxes that no plane separates are split in halves") {
  const FloatBox one = boxAt({3, 4, 5}, {1, 1, 1}), point = boxAt({3, 4, 5}, {0, 0, 0});
  for (const FloatBox& box : {one, point}) {
    const std::vector<FloatBox> boxes(1000, box);
    CHECK(CheckedTree(boxes, 1).tree().depth == 11);
  }
  // Different boxes with the same centre.
  std::vector<FloatBox> nested;
  for (int i = 1; i <= 256; ++i) nested.push_back(boxAt({0, 0, 0}, {double(i), double(i), double(i)}));
  CHECK(CheckedTree(nested, 1).tree().depth == 9);
}

TEST_CASE("boxes of every size and distance that floats can represent make a valid tree") {
  std::vector<FloatBox> boxes;
  for (int exponent = -149; exponent <= 127; ++exponent) {
    const float at = std::ldexp(1.0f, exponent);
    boxes.push_back({{at, 0, 0}, {at, 0, 0}});
    boxes.push_back({{-at, -at, -at}, {at, at, at}});
  }
  boxes.push_back({{-3e38f, -3e38f, -3e38f}, {3e38f, 3e38f, 3e38f}});
  boxes.push_back({{3e38f, 3e38f, 3e38f}, {3.1e38f, 3.1e38f, 3.1e38f}});
  boxes.push_back({{-3.1e38f, 0, 0}, {-3e38f, 0, 0}});
  CHECK(CheckedTree(boxes, 1).tree().depth < 300);
}

TEST_CASE("the root separates clusters that are far apart") {
  // Two clusters of 90 and 10 boxes, far apart along each axis in turn.
  for (int axis = 0; axis < 3; ++axis) {
    Random random(7);
    std::vector<FloatBox> boxes;
    for (int i = 0; i < 100; ++i) {
      std::array<double, 3> at = random.inBox({0, 0, 0}, {10, 10, 10});
      if (i % 10 == 0) at[axis] += 500;
      boxes.push_back(boxAt(at, {0.5, 0.5, 0.5}));
    }
    const CheckedTree checked(boxes, 1);
    CHECK(checked.tree().nodes[1].count == 90);
    CHECK(checked.tree().nodes[2].count == 10);
    CHECK(checked.boxOf(2).lo[axis] > 400);
  }
}

TEST_CASE("a tree is the same on one thread and on several, whose parts are of any size") {
  std::vector<FloatBox> boxes = randomBoxes(200'000, 5);  // enough boxes for several threads
  const uint32_t leafSize = GENERATE(1u, 2u);
  // A far cluster of one, and others that no plane separates.
  boxes[0] = boxAt({1e6, 0, 0}, {1, 1, 1});
  for (size_t i = 1; i < 100'000; ++i) boxes[i] = boxAt({50, 50, 0}, {1, 1, 1});
  CHECK(CheckedTree(boxes, leafSize) == CheckedTree(boxes, leafSize, true));
}
