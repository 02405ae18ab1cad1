#include "scene/box_tree.h"

#include <algorithm>
#include <future>
#include <limits>

#include "math/vector.h"
#include "scene/parallel.h"

namespace radar {

namespace {

constexpr int kBins = 16;
// With fewer items, a thread costs more than it saves.
constexpr size_t kWorthAThread = 1u << 15;

struct Item {
  FloatBox box;
  uint32_t id;
};

struct Growing {
  std::array<float, 3> lo{kMost, kMost, kMost}, hi{-kMost, -kMost, -kMost};
  static constexpr float kMost = std::numeric_limits<float>::max();

  void add(const std::array<float, 3>& p, const std::array<float, 3>& q) {
    for (int k = 0; k < 3; ++k) {
      lo[k] = std::min(lo[k], p[k]);
      hi[k] = std::max(hi[k], q[k]);
    }
  }
  // In doubles, since squares of floats may overflow.
  double area() const {
    const double x = double(hi[0]) - lo[0], y = double(hi[1]) - lo[1], z = double(hi[2]) - lo[2];
    return x < 0 ? 0 : x * y + y * z + z * x;
  }
};

float middle(const FloatBox& box, int axis) {
  return 0.5f * box.lo[axis] + 0.5f * box.hi[axis];
}

struct Cut {
  int axis = -1;
  uint32_t bin = 0;  ///< first bin of the right side
};

// Assigns items to bins by their middles. Extents are doubles, since those of floats may overflow.
class Binning {
 public:
  explicit Binning(const Growing& middles) {
    for (int k = 0; k < 3; ++k) {
      first_[k] = middles.lo[k];
      const double width = double(middles.hi[k]) - middles.lo[k];
      scale_[k] = width > 0 ? kBins / width : 0;
    }
  }
  bool spreads(int axis) const { return scale_[axis] > 0; }
  uint32_t binOf(const FloatBox& box, int axis) const {
    const double at = (double(middle(box, axis)) - first_[axis]) * scale_[axis];
    return std::min<uint32_t>(kBins - 1, static_cast<uint32_t>(std::max(at, 0.0)));
  }

 private:
  Vector first_{}, scale_{};
};

// The cut with the least sum of (area times number of items) over both sides.
Cut bestCut(std::span<const Item> items, const Binning& binning) {
  Cut best;
  double bestCost = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    if (!binning.spreads(k)) continue;
    Growing bins[kBins];
    uint32_t counts[kBins] = {};
    for (const Item& item : items) {
      const uint32_t bin = binning.binOf(item.box, k);
      bins[bin].add(item.box.lo, item.box.hi);
      ++counts[bin];
    }
    double right[kBins];
    Growing around;
    uint32_t count = 0;
    for (uint32_t bin = kBins - 1; bin > 0; --bin) {
      around.add(bins[bin].lo, bins[bin].hi);
      count += counts[bin];
      right[bin] = around.area() * count;
    }
    around = {};
    count = 0;
    for (uint32_t bin = 1; bin < kBins; ++bin) {
      around.add(bins[bin - 1].lo, bins[bin - 1].hi);
      count += counts[bin - 1];
      const double cost = around.area() * count + right[bin];
      if (cost < bestCost && count != 0 && count != items.size()) {
        bestCost = cost;
        best = {k, bin};
      }
    }
  }
  return best;
}

// Moves the items of the left side to the front; returns their number.
size_t split(std::span<Item> items, const Growing& middles) {
  const Binning binning(middles);
  const Cut cut = bestCut(items, binning);
  size_t left = 0;
  if (cut.axis >= 0) {
    const auto at = std::partition(items.begin(), items.end(),
                                   [&](const Item& item) { return binning.binOf(item.box, cut.axis) < cut.bin; });
    left = static_cast<size_t>(at - items.begin());
  }
  // If all middles coincide, any halves will do.
  return left == 0 || left == items.size() ? items.size() / 2 : left;
}

struct Subtree {
  std::vector<BoxTree::Node> nodes;
  uint32_t depth = 0;
};

class Builder {
 public:
  Builder(std::span<Item> items, uint32_t leafSize) : items_(items), leafSize_(leafSize) {}

  Subtree build(size_t first, size_t count, unsigned threads) {
    if (threads < 2 || count < kWorthAThread) return buildAlone(first, count);
    Growing middles;
    BoxTree::Node root = fit(first, count, middles);
    const size_t left = split(items_.subspan(first, count), middles);
    auto other = std::async(std::launch::async, [&] { return build(first + left, count - left, threads / 2); });
    const Subtree near = build(first, left, threads - threads / 2), far = other.get();
    root.child = 1;
    Subtree whole{{root, near.nodes[0], far.nodes[0]}, 1 + std::max(near.depth, far.depth)};
    append(whole, near, 1);
    append(whole, far, 2);
    return whole;
  }

 private:
  BoxTree::Node fit(size_t first, size_t count, Growing& middles) const {
    Growing box;
    for (const Item& item : items_.subspan(first, count)) {
      box.add(item.box.lo, item.box.hi);
      const std::array<float, 3> at{middle(item.box, 0), middle(item.box, 1), middle(item.box, 2)};
      middles.add(at, at);
    }
    return {{box.lo, box.hi}, static_cast<uint32_t>(first), static_cast<uint32_t>(count), 0};
  }

  Subtree buildAlone(size_t first, size_t count) {
    struct Open {
      size_t node, first, count;
      uint32_t depth;
    };
    Subtree tree;
    tree.nodes.reserve(2 * count / leafSize_ + 1);
    tree.nodes.emplace_back();
    std::vector<Open> open{{0, first, count, 1}};
    while (!open.empty()) {
      const Open next = open.back();
      open.pop_back();
      tree.depth = std::max(tree.depth, next.depth);
      Growing middles;
      BoxTree::Node node = fit(next.first, next.count, middles);
      if (next.count > leafSize_) {
        const size_t left = split(items_.subspan(next.first, next.count), middles);
        const size_t child = tree.nodes.size();
        node.child = static_cast<uint32_t>(child);
        tree.nodes.resize(child + 2);
        open.push_back({child + 1, next.first + left, next.count - left, next.depth + 1});
        open.push_back({child, next.first, left, next.depth + 1});
      }
      tree.nodes[next.node] = node;
    }
    return tree;
  }

  // Appends a subtree, whose root goes to index `at`.
  static void append(Subtree& whole, const Subtree& part, size_t at) {
    const auto offset = static_cast<uint32_t>(whole.nodes.size() - 1);
    const auto moved = [&](BoxTree::Node node) {
      if (node.child != 0) node.child += offset;
      return node;
    };
    whole.nodes[at] = moved(part.nodes[0]);
    for (size_t i = 1; i < part.nodes.size(); ++i) whole.nodes.push_back(moved(part.nodes[i]));
  }

  std::span<Item> items_;
  uint32_t leafSize_;
};

}  // namespace

BoxTree buildBoxTree(std::span<const FloatBox> boxes, uint32_t leafSize, unsigned threads) {
  BoxTree tree;
  if (boxes.empty()) return tree;
  std::vector<Item> items(boxes.size());
  for (uint32_t i = 0; i < items.size(); ++i) items[i] = {boxes[i], i};
  Subtree whole = Builder(items, leafSize).build(0, items.size(), threadCount(threads));
  tree.nodes = std::move(whole.nodes);
  tree.depth = whole.depth;
  tree.order.resize(items.size());
  for (size_t i = 0; i < items.size(); ++i) tree.order[i] = items[i].id;
  return tree;
}

}  // namespace radar
