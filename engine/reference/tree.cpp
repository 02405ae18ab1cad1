#include "reference/tree.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace radar::reference {

namespace {

constexpr uint32_t kBins = 16;

template <class Real>
Real centre(const Bounds<Real>& box, int axis) {
  return box.lo[axis] / 2 + box.hi[axis] / 2;
}

template <class Real>
struct Growing {
  Real lo[3], hi[3];
  Growing() {
    std::fill(lo, lo + 3, std::numeric_limits<Real>::max());
    std::fill(hi, hi + 3, std::numeric_limits<Real>::lowest());
  }
  template <class Box>
  void add(const Box& box) {
    for (int k = 0; k < 3; ++k) {
      lo[k] = std::min(lo[k], box.lo[k]);
      hi[k] = std::max(hi[k], box.hi[k]);
    }
  }
  double area() const {
    const double x = double(hi[0]) - lo[0], y = double(hi[1]) - lo[1], z = double(hi[2]) - lo[2];
    return x < 0 ? 0 : x * y + y * z + z * x;
  }
};

}  // namespace

template <class Real>
struct Tree<Real>::Job {
  uint32_t node, begin, end;
};

template <class Real>
void Tree<Real>::fit(Node& node, std::span<const Bounds<Real>> boxes) const {
  Growing<Real> around;
  if (node.count == 0) {
    around.add(nodes_[node.first]);
    around.add(nodes_[node.first + 1]);
  }
  for (uint32_t i = 0; i < node.count; ++i) around.add(boxes[order_[node.first + i]]);
  std::copy(around.lo, around.lo + 3, node.lo);
  std::copy(around.hi, around.hi + 3, node.hi);
}

template <class Real>
uint32_t Tree<Real>::split(const Job& job, std::span<const Bounds<Real>> boxes) {
  Real lo[3], hi[3];
  for (int k = 0; k < 3; ++k) {
    lo[k] = std::numeric_limits<Real>::max();
    hi[k] = std::numeric_limits<Real>::lowest();
    for (uint32_t i = job.begin; i < job.end; ++i) {
      const Real c = centre(boxes[order_[i]], k);
      lo[k] = std::min(lo[k], c);
      hi[k] = std::max(hi[k], c);
    }
  }
  double best = std::numeric_limits<double>::infinity();
  int bestAxis = -1;
  uint32_t bestBin = 0;
  const auto binOf = [&](uint32_t item, int k) {
    const double place = (double(centre(boxes[item], k)) - lo[k]) / (double(hi[k]) - lo[k]);
    return std::min(kBins - 1, static_cast<uint32_t>(place * kBins));
  };
  for (int k = 0; k < 3; ++k) {
    if (!(hi[k] > lo[k])) continue;
    Growing<Real> bins[kBins];
    uint32_t counts[kBins] = {};
    for (uint32_t i = job.begin; i < job.end; ++i) {
      const uint32_t bin = binOf(order_[i], k);
      bins[bin].add(boxes[order_[i]]);
      ++counts[bin];
    }
    double right[kBins];
    Growing<Real> around;
    uint32_t count = 0;
    for (uint32_t bin = kBins; bin-- > 1;) {
      around.add(bins[bin]);
      count += counts[bin];
      right[bin] = around.area() * count;
    }
    around = {};
    count = 0;
    for (uint32_t bin = 1; bin < kBins; ++bin) {
      around.add(bins[bin - 1]);
      count += counts[bin - 1];
      const double cost = around.area() * count + right[bin];
      if (cost < best && count != 0 && count != job.end - job.begin) {
        best = cost;
        bestAxis = k;
        bestBin = bin;
      }
    }
  }
  const uint32_t middle = job.begin + (job.end - job.begin) / 2;
  if (bestAxis < 0) return middle;
  const auto at = std::partition(order_.begin() + job.begin, order_.begin() + job.end,
                                 [&](uint32_t item) { return binOf(item, bestAxis) < bestBin; });
  const uint32_t place = static_cast<uint32_t>(at - order_.begin());
  return place == job.begin || place == job.end ? middle : place;
}

template <class Real>
void Tree<Real>::build(std::span<const Bounds<Real>> boxes, uint32_t leafSize) {
  nodes_.clear();
  order_.resize(boxes.size());
  std::iota(order_.begin(), order_.end(), 0u);
  if (boxes.empty()) return;
  nodes_.reserve(2 * boxes.size() / leafSize + 2);
  nodes_.emplace_back();
  std::vector<Job> jobs{{0, 0, static_cast<uint32_t>(boxes.size())}};
  while (!jobs.empty()) {
    const Job job = jobs.back();
    jobs.pop_back();
    if (job.end - job.begin <= leafSize) {
      nodes_[job.node].first = job.begin;
      nodes_[job.node].count = job.end - job.begin;
      continue;
    }
    const uint32_t middle = split(job, boxes);
    const uint32_t left = static_cast<uint32_t>(nodes_.size());
    nodes_.resize(nodes_.size() + 2);
    nodes_[job.node].first = left;
    nodes_[job.node].count = 0;
    jobs.push_back({left + 1, middle, job.end});
    jobs.push_back({left, job.begin, middle});
  }
  refit(boxes);
}

template <class Real>
void Tree<Real>::refit(std::span<const Bounds<Real>> boxes) {
  for (size_t i = nodes_.size(); i-- > 0;) fit(nodes_[i], boxes);  // children come after their parents
}

template <class Real>
double Tree<Real>::area() const {
  double sum = 0;
  for (const Node& node : nodes_) {
    Growing<Real> box;
    box.add(node);
    sum += box.area();
  }
  return sum;
}

template class Tree<float>;
template class Tree<double>;

}  // namespace radar::reference
