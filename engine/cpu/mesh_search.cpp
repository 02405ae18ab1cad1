#include "cpu/mesh_search.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "cpu/node_gap.h"

namespace radar::cpu {

namespace {

// Two nodes whose sizes differ by less than this factor are both opened; else the larger is opened by two levels.
constexpr float kSimilar = 4;
// Floats are used if they round positions by at most this fraction of a mean triangle edge.
constexpr double kFloatShare = 0.125;
// Of pairs of nodes, between two looks at whether the search is still wanted.
constexpr uint32_t kVisits = 1024;

uint32_t trianglesOf(const gpu::MeshNode& leaf) {
  return (leaf.link & gpu::kLinkPair) != 0 ? 2 : 1;
}

float sizeOf(const gpu::MeshNode& node) {
  return node.halfExtent[0] + node.halfExtent[1] + node.halfExtent[2];
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

/// Splits pairs of nodes.
class Opener {
 public:
  /// `matrix`: from A's frame to B's.
  Opener(const Mesh& a, const Mesh& b, const Matrix3& matrix) : nodesA_(a.tree.nodes), nodesB_(b.tree.nodes) {
    double scale = 0;
    for (const Vector& row : matrix) scale += norm1(row);
    scale_ = static_cast<float>(std::min(scale / 3, 0x1p100));
  }

  /// The four parts of a pair (a, b), not both leaves, of which `count` differ.
  struct Parts {
    uint32_t a[4], b[4];
    unsigned valid;  ///< one bit per part; 0 if it repeats another
    uint32_t count;
  };
  Parts open(uint32_t placeA, uint32_t placeB) const {
    Parts out;
    const gpu::MeshNode &a = nodesA_[placeA], &b = nodesB_[placeB];
    const bool leafA = isLeaf(a), leafB = isLeaf(b);
    const float sizeA = scale_ * sizeOf(a), sizeB = sizeOf(b);
    if (!leafA && !leafB && sizeA < kSimilar * sizeB && sizeB < kSimilar * sizeA) {
      for (uint32_t i = 0; i < 4; ++i) {
        out.a[i] = a.link + (i & 1);
        out.b[i] = b.link + (i >> 1);
      }
      out.valid = 0b1111;
      out.count = 4;
    } else if (leafB || (!leafA && sizeA > sizeB)) {
      std::fill_n(out.b, 4, placeB);
      openTwice(nodesA_, a.link, out.a, out);
    } else {
      std::fill_n(out.a, 4, placeA);
      openTwice(nodesB_, b.link, out.b, out);
    }
    return out;
  }

 private:
  /// The children of the nodes `first` and `first` + 1; a leaf stands for itself.
  static void openTwice(const std::vector<gpu::MeshNode>& nodes, uint32_t first, uint32_t (&places)[4], Parts& out) {
    out.valid = 0;
    out.count = 0;
    for (uint32_t i = 0; i < 2; ++i) {
      const bool leaf = isLeaf(nodes[first + i]);
      places[2 * i] = leaf ? first + i : nodes[first + i].link;
      places[2 * i + 1] = places[2 * i] + (leaf ? 0 : 1);
      out.valid |= (leaf ? 0b01u : 0b11u) << (2 * i);
      out.count += leaf ? 1 : 2;
    }
  }

  const std::vector<gpu::MeshNode>&nodesA_, &nodesB_;
  float scale_;  // of A's nodes in B's frame
};

constexpr int32_t kNever = 0x7f800000;  // the bits of infinity

/// A key that orders like `from`, rounded down, with the lane's number in its low two bits.
int32_t keyOf(float from, int lane) {
  const auto bits = std::bit_cast<int32_t>(from);
  return ((bits ^ (bits >> 31 & 0x7fffffff)) & ~3) | lane;
}

float nearOf(int32_t key) {
  return std::bit_cast<float>(std::max(key, 0) & ~3);
}

/// Keys of the lanes, nearest last; at least kNever if the pair does not meet. Of the pairs that may meet at the start,
/// the one whose interval begins earliest is nearest: it usually is the deepest. In shapes that interlock, most pairs
/// may meet at the start.
template <class Real>
std::array<int32_t, 4> inOrder(const Times<Real>& times, unsigned valid) {
  Lanes<Real> from = times.from;
  if constexpr (sizeof(Real) > sizeof(float)) {
    // Moved down by more than the conversion can round up, and clamped to the range of floats.
    from = from - abs(from) * Lanes<Real>(0x1p-23);
    from = max(Lanes<Real>(-0x1p100), min(from, Lanes<Real>(0x1p100)));
  }
  from = select(max(times.from, Lanes<Real>(0)), times.to, Lanes<Real>(Real(INFINITY)), from);
  const FourFloats floats = from.floats();
  std::array<int32_t, 4> keys;
  for (int i = 0; i < 4; ++i) {
    const int32_t invalid = static_cast<int32_t>(valid >> i & 1) - 1;  // all bits, or none
    keys[i] = (keyOf(floats[i], i) & ~invalid) | ((kNever | i) & invalid);
  }
  // Without a branch, which nothing could foresee, and which compilers make of std::max().
  const auto sort = [&](int i, int j) {
    const int64_t above = int64_t{keys[i]} - keys[j], swapped = above & above >> 63;
    keys[i] = static_cast<int32_t>(keys[i] - swapped);
    keys[j] = static_cast<int32_t>(keys[j] + swapped);
  };
  sort(0, 1);
  sort(2, 3);
  sort(0, 2);
  sort(1, 3);
  sort(1, 2);
  return keys;
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
  Times<Real> times(const FourNodes& a, const FourNodes& b) const {
    Times<Real> times = nodeTimes_(a, b);
    if (pair_.motion.clearance == 0) return times;
    Real from[4];
    for (int i = 0; i < 4; ++i) {
      from[i] = times.from[i];
      if (!(from[i] <= times.to[i] && from[i] <= latest_)) continue;
      if (const double reached = reach_.reached(*a[i], *b[i], latest_); reached > 0) {
        from[i] = std::max(from[i], static_cast<Real>(reached));
      }
    }
    times.from = from;
    return times;
  }
  /// Passes the pairs of triangles of two leaves to the visitor, earliest first.
  void meet(const gpu::MeshNode& a, const gpu::MeshNode& b, float near);

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
void StraightTest<Real>::meet(const gpu::MeshNode& a, const gpu::MeshNode& b, float near) {
  const LeafTimes<Real> found = leaves_(a, b, near, end_);
  pairs_ += trianglesOf(a) * trianglesOf(b);
  for (unsigned pending = found.possible; pending != 0 && !visitor_.isDecided();) {
    int lane = std::countr_zero(pending);
    for (int i = lane + 1; i < 4; ++i) {
      if ((pending >> i & 1) != 0 && found.times.from[i] < found.times.from[lane]) lane = i;
    }
    pending &= ~(1u << lane);
    if (found.times.from[lane] > Real(1 + 4 * kRounding<Real>) * (end_ - near)) return;
    const TrianglePlacer::Placed &ofA = placeA_(a, lane & 1), &ofB = placeB_(b, lane >> 1);
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
  Times<double> times(const FourNodes& a, const FourNodes& b) const { return nodeTimes_(a, b); }
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

 private:
  const PathPair& pair_;
  PathContact& contact_;
  uint64_t& pairs_;
  const PathTest& nodeTimes_;
  TrianglePlacer placeA_, placeB_;
};

}  // namespace

PathPair pairOf(const PlacedMesh& body, const PathPart& part, const PlacedMesh& object, ObjectId name,
                const Vector& drift, double clearance) {
  PathPair pair{body, object, name};
  pair.from = part.from;
  pair.end = part.end;
  for (int e = 0; e < 2; ++e) {
    pair.a[e] = {&part.at[e], &part.axes[e]};
    pair.b[e] = {&object.placement, nullptr};
    const Vector moved = along(object.placement.origin, e == 0 ? part.from : part.end, drift);
    pair.gap[e] = minus(moved, part.at[e].origin);
  }
  pair.apart = clearance + part.error + 8 * kUnit * norm1(drift);
  pair.bend = part.bend;
  return pair;
}

void MeshSearch::run(const MeshPair& pair, double near, PairVisitor& visitor, uint64_t& pairs,
                     const std::stop_token& stop) {
  const auto search = [&](auto test) {
    descend(pair.sensor.mesh.tree, pair.other.mesh.tree,
            Opener(pair.sensor.mesh, pair.other.mesh, pair.fromOther.matrix), pair.object, near, test, visitor, stop);
  };
  if (floatsSuffice(pair)) {
    search(StraightTest<float>(pair, visitor, pairs));
  } else {
    search(StraightTest<double>(pair, visitor, pairs));
  }
}

void MeshSearch::run(const PathPair& pair, PathContact& contact, uint64_t& pairs, const std::stop_token& stop) {
  const MeshTree &treeA = pair.sensor.mesh.tree, &treeB = pair.other.mesh.tree;
  const gpu::MeshNode &rootA = treeA.nodes[0], &rootB = treeB.nodes[0];
  const FourNodes a{&rootA, &rootA, &rootA, &rootA}, b{&rootB, &rootB, &rootB, &rootB};
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
  descend(treeA, treeB, Opener(pair.sensor.mesh, pair.other.mesh, fromOther.matrix[0]), pair.object, 0, test, contact,
          stop);
}

template <class Opener, class Test>
void MeshSearch::descend(const MeshTree& treeA, const MeshTree& treeB, const Opener& opener, ObjectId object,
                         double near, Test& test, PairVisitor& visitor, const std::stop_token& stop) {
  uint32_t visits = 0;
  open_.resize(3 * (size_t{treeA.depth} + treeB.depth) + 4);
  open_[0] = {static_cast<float>((1 - 0x1p-22) * near), 0, 0};
  Open* top = open_.data() + 1;
  while (top != open_.data() && !visitor.isDecided()) {
    --top;
    const float from = top->near;
    if (from > test.latest()) continue;
    const uint32_t placeA = top->a, placeB = top->b;
    if (visitor.isBefore({object, treeB.below[placeB].least, treeA.below[placeA].least})) continue;
    const gpu::MeshNode &a = treeA.nodes[placeA], &b = treeB.nodes[placeB];
    if (test.keepApart(a, b)) continue;
    // To decide a pair of triangles may take as long as to test very many nodes.
    const bool areLeaves = isLeaf(a) && isLeaf(b);
    if (areLeaves || ++visits % kVisits == 0) throwIfStopped(stop);
    if (areLeaves) {
      test.meet(a, b, from);
      continue;
    }
    const typename Opener::Parts parts = opener.open(placeA, placeB);
    FourNodes nodesA, nodesB;
    for (int i = 0; i < 4; ++i) {
      nodesA[i] = &treeA.nodes[parts.a[i]];
      nodesB[i] = &treeB.nodes[parts.b[i]];
    }
    const float latest = test.latest();
    for (const int32_t key : inOrder(test.times(nodesA, nodesB), parts.valid)) {
      // Written member by member, as it is read back: otherwise store forwarding fails and the processor waits.
      top->near = nearOf(key);
      top->a = parts.a[key & 3];
      top->b = parts.b[key & 3];
      top += top->near <= latest;
    }
  }
}

}  // namespace radar::cpu
