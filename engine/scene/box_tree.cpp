#include "scene/box_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "math/lanes.h"
#include "scene/parallel.h"

namespace radar {

namespace {

constexpr uint32_t kBins = 16;
// So few items use few bins; so many are worth two sets of bins. As measured.
constexpr size_t kFew = 16, kMany = 256;
// Fewer items are not worth a thread, nor parts of their own.
constexpr size_t kPart = 1u << 13;

FourFloats loaded(const float (&from)[4]) {
  FourFloats out;
  std::memcpy(&out, from, sizeof(out));
  return out;
}

struct Growing {
  FourFloats lo, hi;

  void add(const Growing& other) {
    lo = other.lo < lo ? other.lo : lo;
    hi = other.hi > hi ? other.hi : hi;
  }
  // In doubles, since squares of floats may overflow.
  double area() const {
    const HalfOfDoubles x = HalfOfDoubles{hi[0], hi[1]} - HalfOfDoubles{lo[0], lo[1]};
    const HalfOfDoubles byZ = x * (double(hi[2]) - lo[2]);
    return x[0] * x[1] + byZ[1] + byZ[0];
  }
};
constexpr float kMost = std::numeric_limits<float>::max();
constexpr Growing kNothing{{kMost, kMost, kMost, kMost}, {-kMost, -kMost, -kMost, -kMost}};

Growing extentOf(const BoxedItem& item) {
  return {loaded(item.lo), loaded(item.hi)};
}

FourFloats middleOf(const BoxedItem& item) {
  return 0.5f * loaded(item.lo) + 0.5f * loaded(item.hi);
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
      const double width = double(middles.hi[k]) - middles.lo[k];
      first_[k / 2][k % 2] = middles.lo[k];
      scale_[k / 2][k % 2] = width > 0 ? kBins / width : 0;
    }
  }
  bool spreads(int axis) const { return scale_[axis / 2][axis % 2] > 0; }
  // Along each axis.
  std::array<uint32_t, 3> binsOf(const FourFloats& middle) const {
    const HalfOfDoubles xy = (HalfOfDoubles{middle[0], middle[1]} - first_[0]) * scale_[0];
    const double z = (double(middle[2]) - first_[1][0]) * scale_[1][0];
    const auto limited = [](double place) { return std::min(kBins - 1, static_cast<uint32_t>(place)); };
    return {limited(xy[0]), limited(xy[1]), limited(z)};
  }
  // Whether an item's bin is before that of a cut.
  bool isLeft(const BoxedItem& item, const Cut& cut) const {
    const int k = cut.axis;
    return (double(0.5f * item.lo[k] + 0.5f * item.hi[k]) - first_[k / 2][k % 2]) * scale_[k / 2][k % 2] < cut.bin;
  }

 private:
  HalfOfDoubles first_[2], scale_[2];
};

// The items of each bin along an axis.
class Bins {
 public:
  // Before items are added to it.
  void clear(uint32_t bin) {
    bins_[bin] = kNothing;
    counts_[bin] = 0;
    used_ |= 1u << bin;
  }
  void add(uint32_t bin, const BoxedItem& item) {
    bins_[bin].add(extentOf(item));
    ++counts_[bin];
  }
  void add(const Bins& other) {
    for (uint32_t bin = 0; bin < kBins; ++bin) {
      bins_[bin].add(other.bins_[bin]);
      counts_[bin] += other.counts_[bin];
    }
  }
  void dropEmpty() {
    for (uint32_t bin = 0; bin < kBins; ++bin) used_ &= ~((counts_[bin] == 0 ? 1u : 0u) << bin);
  }

  // The cut with the least sum of (area times number of items) over both sides, if that is below `least`.
  void improve(Cut& cut, double& least, int axis) const {
    double right[kBins];
    Growing around = kNothing;
    uint32_t count = 0;
    for (uint32_t rest = used_; rest != 0;) {
      const auto bin = static_cast<uint32_t>(std::bit_width(rest) - 1);
      add(around, count, bin);
      right[bin] = around.area() * count;
      rest ^= 1u << bin;
    }
    around = kNothing;
    count = 0;
    for (uint32_t rest = used_; (rest & (rest - 1)) != 0;) {
      add(around, count, static_cast<uint32_t>(std::countr_zero(rest)));
      rest &= rest - 1;
      const auto next = static_cast<uint32_t>(std::countr_zero(rest));
      const double cost = around.area() * count + right[next];
      if (cost < least) {
        least = cost;
        cut = {axis, next};
      }
    }
  }

 private:
  void add(Growing& around, uint32_t& count, uint32_t bin) const {
    around.add(bins_[bin]);
    count += counts_[bin];
  }

  Growing bins_[kBins];
  uint32_t counts_[kBins];
  uint32_t used_ = 0;  // one bit each
};

using AxisBins = std::array<Bins, 3>;

void clear(AxisBins& bins) {
  for (Bins& along : bins) {
    for (uint32_t bin = 0; bin < kBins; ++bin) along.clear(bin);
  }
}

void add(AxisBins& bins, const std::array<uint32_t, 3>& at, const BoxedItem& item) {
  for (int k = 0; k < 3; ++k) bins[k].add(at[k], item);
}

// For many items, of which a thread bins `part` at a time. Not inline, where it slows few down.
[[gnu::noinline]] void addAll(AxisBins& bins, std::span<const BoxedItem> items, const Binning& binning, size_t part) {
  std::mutex merging;
  parallelFor(items.size(), part, 0, [&](unsigned, size_t first, size_t last) {
    // Neighbours often share a bin, and adding to it again has to wait.
    AxisBins even, odd;
    clear(even);
    clear(odd);
    for (size_t i = first; i + 1 < last; i += 2) {
      const auto here = binning.binsOf(middleOf(items[i])), next = binning.binsOf(middleOf(items[i + 1]));
      add(even, here, items[i]);
      add(odd, next, items[i + 1]);
    }
    if ((last - first) % 2 != 0) add(even, binning.binsOf(middleOf(items[last - 1])), items[last - 1]);
    const std::scoped_lock lock(merging);
    for (int k = 0; k < 3; ++k) {
      bins[k].add(even[k]);
      bins[k].add(odd[k]);
    }
  });
}

Cut bestCut(std::span<const BoxedItem> items, const Binning& binning, size_t part) {
  AxisBins bins;
  if (items.size() <= kFew) {
    std::array<uint32_t, 3> at[kFew];
    for (size_t i = 0; i < items.size(); ++i) {
      at[i] = binning.binsOf(middleOf(items[i]));
      for (int k = 0; k < 3; ++k) bins[k].clear(at[i][k]);
    }
    for (size_t i = 0; i < items.size(); ++i) add(bins, at[i], items[i]);
  } else {
    clear(bins);
    if (items.size() < kMany) {
      for (const BoxedItem& item : items) add(bins, binning.binsOf(middleOf(item)), item);
    } else {
      addAll(bins, items, binning, part);
    }
    for (Bins& along : bins) along.dropEmpty();
  }
  Cut cut;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    if (binning.spreads(k)) bins[k].improve(cut, least, k);
  }
  return cut;
}

class Builder {
 public:
  Builder(std::span<BoxedItem> items, uint32_t leafSize, bool alone)
      : items_(items), leafSize_(leafSize), part_(alone ? items.size() + 1 : kPart) {}

  BoxTree build() {
    tree_.nodes.resize(2 * items_.size() - 1);
    std::vector<Part> large, parts;
    const auto list = [&](const Part& part) { (part.range.count < part_ ? parts : large).push_back(part); };
    list({whole(), 0, 1, 1, 1});
    while (!large.empty()) {
      const std::vector<Part> level = std::exchange(large, {});
      std::vector<std::array<Part, 2>> sides(level.size());
      parallelFor(level.size(), 1, 0, [&](unsigned, size_t i, size_t) { sides[i] = divided(level[i]); });
      for (const auto& [left, right] : sides) {
        list(left);
        list(right);
      }
    }
    parallelFor(parts.size(), 1, 0, [&](unsigned, size_t i, size_t) { build(parts[i]); });
    std::ranges::sort(parts, {}, &Part::first);
    const Part* part = parts.data();
    size_t end = 1;
    settle(0, end, part);
    tree_.nodes.resize(end);
    return std::move(tree_);
  }

 private:
  struct Range {
    size_t first, count;
    Growing middles;  // around those of its boxes
    void add(const BoxedItem& item) { middles.add({middleOf(item), middleOf(item)}); }
  };
  // A node, and the places of those below it, as many as leaves of one item would take.
  struct Part {
    Range range;
    size_t node, first, last;
    uint32_t depth;  ///< of the node; then of the deepest below it
  };

  Range whole() const {
    Range all{0, items_.size(), kNothing};
    std::mutex merging;
    parallelFor(items_.size(), part_, 0, [&](unsigned, size_t first, size_t last) {
      Range some{first, last - first, kNothing};
      for (size_t i = first; i < last; ++i) some.add(items_[i]);
      const std::scoped_lock lock(merging);
      all.middles.add(some.middles);
    });
    return all;
  }

  static BoxTree::Node nodeOf(const Range& range, size_t child) {
    return {static_cast<uint32_t>(range.first), static_cast<uint32_t>(range.count), static_cast<uint32_t>(child)};
  }

  std::array<Part, 2> divided(const Part& part) {
    const size_t child = part.first;
    tree_.nodes[part.node] = nodeOf(part.range, child);
    const auto [left, right] = split(part.range);
    const size_t middle = child + 2 * left.count;
    return {Part{left, child, child + 2, child + 2, part.depth + 1},
            {right, child + 1, middle, middle, part.depth + 1}};
  }

  void build(Part& part) {
    struct Open {
      size_t node;
      uint32_t depth;
      Range range;
    };
    std::vector<Open> open{{part.node, part.depth, part.range}};
    while (!open.empty()) {
      const Open next = open.back();
      open.pop_back();
      part.depth = std::max(part.depth, next.depth);
      const bool isLeaf = next.range.count <= leafSize_;
      tree_.nodes[next.node] = nodeOf(next.range, isLeaf ? 0 : part.last);
      if (isLeaf) continue;
      const std::array<Range, 2> sides = split(next.range);
      for (const size_t side : {1, 0}) open.push_back({part.last + side, next.depth + 1, sides[side]});
      part.last += 2;
    }
  }

  // Moves the nodes below one to `end`.
  void settle(size_t at, size_t& end, const Part*& part) {
    BoxTree::Node* const nodes = tree_.nodes.data();
    if (nodes[at].count >= part_) {
      const size_t child = end;
      std::copy_n(nodes + nodes[at].child, 2, nodes + child);
      nodes[at].child = static_cast<uint32_t>(child);
      end += 2;
      settle(child, end, part);
      settle(child + 1, end, part);
      return;
    }
    const size_t first = part->first, last = part->last;
    tree_.depth = std::max(tree_.depth, part++->depth);
    const auto gap = static_cast<uint32_t>(first - end);
    if (gap != 0) {
      std::copy(nodes + first, nodes + last, nodes + end);
      const auto close = [&](BoxTree::Node& node) { node.child -= node.child != 0 ? gap : 0; };
      close(nodes[at]);
      std::for_each(nodes + end, nodes + end + (last - first), close);
    }
    end += last - first;
  }

  // Sorts the items of a node into those of its children.
  std::array<Range, 2> split(const Range& range) {
    const std::span<BoxedItem> items = items_.subspan(range.first, range.count);
    const Binning binning(range.middles);
    const Cut cut = bestCut(items, binning, part_);
    Range left{range.first, 0, kNothing}, right{range.first, 0, kNothing};
    size_t first = 0, last = items.size();
    if (cut.axis < 0) {  // all middles coincide: any halves will do
      while (first < items.size() / 2) left.add(items[first++]);
      for (size_t i = first; i < last; ++i) right.add(items[i]);
    } else {
      const auto isLeft = [&](size_t i) { return binning.isLeft(items[i], cut); };
      for (;;) {
        while (first < last && isLeft(first)) left.add(items[first++]);
        while (first < last && !isLeft(last - 1)) right.add(items[--last]);
        if (first == last) break;
        std::swap(items[first], items[last - 1]);
        left.add(items[first++]);
        right.add(items[--last]);
      }
    }
    left.count = first;
    right.first += first;
    right.count = range.count - first;
    return {left, right};
  }

  const std::span<BoxedItem> items_;
  const uint32_t leafSize_;
  const size_t part_;  // nodes of fewer items are built with all below them
  BoxTree tree_;
};

}  // namespace

BoxTree buildBoxTree(std::span<BoxedItem> items, uint32_t leafSize, bool alone) {
  return items.empty() ? BoxTree{} : Builder(items, leafSize, alone).build();
}

}  // namespace radar
