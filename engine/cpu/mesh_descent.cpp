#include "cpu/mesh_descent.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "cpu/lane_order.h"
#include "cpu/leaf_test.h"
#include "cpu/node_gap.h"
#include "cpu/node_opener.h"
#include "cpu/path_test.h"

#ifndef RADAR_DESCENT
#define RADAR_DESCENT commonDescent
#define RADAR_INSTRUCTIONS "common"
#endif

namespace radar::cpu {

inline namespace RADAR_WIDTH {

namespace {

// Floats are used if they round positions by at most this fraction of a mean triangle edge.
constexpr double kFloatShare = 0.125;
// Of pairs of nodes, between two looks at whether the search is still wanted.
constexpr uint32_t kVisits = 1024;

uint32_t trianglesOf(const gpu::MeshNode& leaf) {
  return (leaf.link & gpu::kLinkPair) != 0 ? 2 : 1;
}

bool floatsSuffice(const MeshPair& pair) {
  double scale = 0, magnitude = 0;
  for (int k = 0; k < 3; ++k) {
    magnitude = std::max(magnitude, pair.fromOther.magnitude[k]);
    for (double entry : pair.fromOther.matrix[k]) scale = std::max(scale, std::abs(entry));
  }
  const Mesh &a = pair.sensor.mesh, &b = pair.other.mesh;
  const double edge = std::min(scale * a.meanEdge / a.unit, b.meanEdge / b.unit);
  return 16 * kRounding<float> * magnitude <= kFloatShare * edge;
}

/// Places triangles of leaves. Keeps the last ones, as a triangle often meets several others.
class TrianglePlacer {
 public:
  explicit TrianglePlacer(const PlacedMesh& placed) : placed_(placed) {}

  struct Placed {
    uint32_t triangle = kNone;
    exact::Triangle corners;
  };
  /// `which`: 0 or 1, the first or the second of the leaf.
  const Placed& operator()(const gpu::MeshNode& leaf, unsigned which) {
    const uint32_t triangle = placed_.mesh.tree.order[(leaf.link & gpu::kLinkItem) + which];
    Placed& last = last_[which];
    if (last.triangle != triangle) last = {triangle, placedTriangle(placed_.mesh, placed_.pose, triangle)};
    return last;
  }

 private:
  const PlacedMesh& placed_;
  Placed last_[2];
};

/// Nodes and leaves of meshes of which one moves straight.
template <class Real>
class StraightTest {
 public:
  StraightTest(const MeshPair& pair, PairVisitor& visitor, uint64_t& pairs)
      : pair_(pair),
        visitor_(visitor),
        pairs_(pairs),
        nodeTimes_(pair.fromSensor, pair.fromOther),
        leaves_(pair.sensor.mesh, pair.other.mesh, pair.fromOther),
        placeA_(pair.sensor),
        placeB_(pair.other),
        gap_(pair.sensor.placement, pair.other.placement, pair.motion),
        lead_(gap_),
        reach_(pair.sensor.placement, pair.other.placement, pair.motion) {
    update();
    lead_.set(visitor.lead().way, visitor.lead().by, visitor.latest());
  }

  float latest() const { return latest_; }
  bool keepApart(const gpu::MeshNode& a, const gpu::MeshNode& b) const {
    return gap_.keepApart(a, b) || lead_.keepApart(a, b);
  }
  Times<Real> times(const NodeLanes& a, const NodeLanes& b) const {
    Times<Real> times = nodeTimes_(a, b);
    if (pair_.motion.clearance == 0) return times;
    Real from[kLanes];
    for (int i = 0; i < kLanes; ++i) {
      from[i] = times.from[i];
      if (!(from[i] <= times.to[i] && from[i] <= latest_)) continue;
      if (const double reached = reach_.reached(*a[i], *b[i], latest_); reached > 0) {
        from[i] = std::max(from[i], static_cast<Real>(reached));
      }
    }
    times.from = from;
    return times;
  }
  /// Passes the pairs of triangles of leaves to the visitor, earliest first.
  void meet(const LeafPairs& leaves);

 private:
  void update() {
    if (visitor_.latest() != seen_) {
      seen_ = visitor_.latest();
      const double time = pair_.motion.timeOf(seen_);
      latest_ = static_cast<float>((1 + 0x1p-22) * time);
      // Raised by more than rounding to Real may lower it.
      end_ = static_cast<Real>((1 + 4 * kRounding<Real>)*time);
    }
    // With a clearance, slabs along the meshes' axes let pass what is up to 1.7 clearances away. The gap of a pair
    // found so far tells more.
    if (pair_.motion.clearance > 0) gap_.set(visitor_.across(), pair_.motion.clearance, seen_);
  }

  const MeshPair& pair_;
  PairVisitor& visitor_;
  uint64_t& pairs_;
  const NodeTest<Real> nodeTimes_;
  LeafTest<Real> leaves_;
  TrianglePlacer placeA_, placeB_;
  GapTest gap_, lead_;
  NodeGap reach_;
  double seen_ = -1;  // the visitor's latest t, of which the next two are times
  float latest_ = 0;
  Real end_ = 0;
};

template <class Real>
void StraightTest<Real>::meet(const LeafPairs& leaves) {
  const LeafTimes<Real> found = leaves_.timesOf(leaves, end_);
  for (int m = 0; m < leaves.count; ++m) pairs_ += trianglesOf(*leaves.a[m]) * trianglesOf(*leaves.b[m]);
  for (unsigned pending = found.possible; pending != 0 && !visitor_.isDecided();) {
    int lane = std::countr_zero(pending);
    for (unsigned others = pending & (pending - 1); others != 0; others &= others - 1) {
      const int i = std::countr_zero(others);
      if (found.from[i] < found.from[lane]) lane = i;
    }
    if (found.from[lane] > Real(1 + 4 * kRounding<Real>) * end_) return;
    pending &= ~(1u << lane);
    const TrianglePlacer::Placed& ofA = placeA_(*leaves.a[lane / 4], lane & 1);
    const TrianglePlacer::Placed& ofB = placeB_(*leaves.b[lane / 4], lane >> 1 & 1);
    visitor_.consider({pair_.object, ofB.triangle, ofA.triangle}, {ofA.corners, ofB.corners},
                      static_cast<Axis>(found.axis[lane]));
    update();
  }
}

/// The same in a part of other ways.
class PathTests {
 public:
  PathTests(const PathPair& pair, const PathTest& nodeTimes, PathContact& contact, uint64_t& pairs)
      : pair_(pair),
        contact_(contact),
        pairs_(pairs),
        nodeTimes_(nodeTimes),
        placeA_(pair.sensor),
        placeB_(pair.other) {}

  float latest() const {
    const double s = std::min(contact_.latest(), pair_.end) - pair_.from;
    return static_cast<float>((1 + 0x1p-22) * (s / (pair_.end - pair_.from)));
  }
  bool keepApart(const gpu::MeshNode&, const gpu::MeshNode&) const { return false; }
  Times<double> times(const NodeLanes& a, const NodeLanes& b) const { return nodeTimes_(a, b); }
  void meet(const LeafPairs& leaves) {
    for (int m = 0; m < leaves.count; ++m) meet(*leaves.a[m], *leaves.b[m], leaves.near[m]);
  }

 private:
  void meet(const gpu::MeshNode& a, const gpu::MeshNode& b, float near) {
    pairs_ += trianglesOf(a) * trianglesOf(b);
    double early = (1 - 0x1p-22) * near;
    if (pair_.steps > 0) early = std::floor(early * pair_.steps) / pair_.steps;
    const double from = pair_.from + early * (pair_.end - pair_.from);
    for (unsigned i = 0; i < trianglesOf(a); ++i) {
      for (unsigned k = 0; k < trianglesOf(b) && !contact_.isDecided(); ++k) {
        contact_.setTimes(from, pair_.end);
        const TrianglePlacer::Placed &ofA = placeA_(a, i), &ofB = placeB_(b, k);
        contact_.consider({pair_.object, ofB.triangle, ofA.triangle}, {ofA.corners, ofB.corners}, 0);
      }
    }
  }

  const PathPair& pair_;
  PathContact& contact_;
  uint64_t& pairs_;
  const PathTest& nodeTimes_;
  TrianglePlacer placeA_, placeB_;
};

template <class Test>
void descend(const MeshTree& treeA, const MeshTree& treeB, const NodeOpener& opener, ObjectId object, double near,
             Test& test, PairVisitor& visitor, OpenPair* open, const std::stop_token& stop) {
  uint32_t visits = 0;
  OpenPair* top = open;
  *top++ = {static_cast<float>((1 - 0x1p-22) * near), 0, 0};
  const auto areLeaves = [&](const OpenPair& pair) {
    return (treeA.nodes[pair.a].link & treeB.nodes[pair.b].link & gpu::kLinkLeaf) != 0;
  };
  LeafPairs leaves;
  NodeOpener::Parts parts;
  while (!visitor.isDecided()) {
    if (leaves.count == LeafPairs::kMost || (leaves.count > 0 && (top == open || !areLeaves(top[-1])))) {
      test.meet(leaves);
      leaves.count = 0;
      continue;
    }
    if (top == open) return;
    --top;
    const float from = top->near;
    if (from > test.latest()) continue;
    const uint32_t placeA = top->a, placeB = top->b;
    if (visitor.meetsAtStart() && visitor.isBefore({object, treeB.below[placeB].least, treeA.below[placeA].least})) {
      continue;
    }
    const gpu::MeshNode &a = treeA.nodes[placeA], &b = treeB.nodes[placeB];
    if (test.keepApart(a, b)) continue;
    // To decide a pair of triangles may take as long as to test very many nodes.
    const bool isPairOfLeaves = (a.link & b.link & gpu::kLinkLeaf) != 0;
    if (isPairOfLeaves || ++visits % kVisits == 0) throwIfStopped(stop);
    if (isPairOfLeaves) {
      leaves.add(a, b, from);
      continue;
    }
    opener.open(a, b, parts);
    const Ordered next = inOrder(test.times(parts.a, parts.b), parts.valid, test.latest());
    for (int i = kLanes - next.count; i < kLanes; ++i, ++top) {
      const int lane = next.keys[i] & kLaneOfKey;
      // Written member by member, as it is read back: otherwise store forwarding fails and the processor waits.
      top->near = nearOf(next.keys[i]);
      top->a = static_cast<uint32_t>(parts.a[lane] - treeA.nodes.data());
      top->b = static_cast<uint32_t>(parts.b[lane] - treeB.nodes.data());
    }
  }
}

void searchStraight(const MeshPair& pair, double near, PairVisitor& visitor, OpenPair* open, uint64_t& pairs,
                    const std::stop_token& stop) {
  const NodeOpener opener(pair.sensor.mesh, pair.other.mesh, pair.fromOther.matrix);
  const auto search = [&](auto&& test) {
    descend(pair.sensor.mesh.tree, pair.other.mesh.tree, opener, pair.object, near, test, visitor, open, stop);
  };
  if (floatsSuffice(pair)) {
    search(StraightTest<float>(pair, visitor, pairs));
  } else {
    search(StraightTest<double>(pair, visitor, pairs));
  }
}

void searchPath(const PathPair& pair, PathContact& contact, OpenPair* open, uint64_t& pairs,
                const std::stop_token& stop) {
  const MeshTree &treeA = pair.sensor.mesh.tree, &treeB = pair.other.mesh.tree;
  const gpu::MeshNode &rootA = treeA.nodes[0], &rootB = treeB.nodes[0];
  NodeLanes a, b;
  a.fill(&rootA);
  b.fill(&rootB);
  const auto seenFrom = [&](const PathPair::End* own, const PathPair::End* other, const MeshAxes* axes, double sign,
                            double bend) {
    PathPlacement::Frame frame{{axes, axes},
                               {own[0].placement, own[1].placement},
                               {other[0].placement, other[1].placement},
                               {scaled(sign, pair.gap[0]), scaled(sign, pair.gap[1])},
                               pair.apart,
                               bend,
                               pair.axis};
    for (int e = 0; e < 2; ++e) {
      if (own[e].axes != nullptr) frame.axes[e] = own[e].axes;
    }
    return PathPlacement(frame);
  };
  const PathPlacement fromSensor = seenFrom(pair.a, pair.b, nullptr, 1, pair.bendSeen);
  if (PathTest::areApart(fromSensor, a, b)) return;
  const MeshAxes axes = pair.b[0].axes != nullptr ? *pair.b[0].axes : MeshAxes(pair.b[0].placement->linear);
  const PathPlacement fromOther = seenFrom(pair.b, pair.a, &axes, -1, pair.bend);
  if (PathTest::areApart(fromOther, b, a)) return;
  const PathTest nodeTimes(fromSensor, fromOther);
  PathTests test(pair, nodeTimes, contact, pairs);
  descend(treeA, treeB, NodeOpener(pair.sensor.mesh, pair.other.mesh, fromOther.matrix[0]), pair.object, 0, test,
          contact, open, stop);
}

}  // namespace

}  // namespace RADAR_WIDTH

const MeshDescent* RADAR_DESCENT() {
  static constexpr MeshDescent kDescent{RADAR_INSTRUCTIONS, searchStraight, searchPath};
  return &kDescent;
}

}  // namespace radar::cpu
