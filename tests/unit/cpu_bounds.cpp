// The bounds of the CPU's search contain the exact time of contact, for every pair of nodes and of triangles, not only
// for those that a search visits.
#include <algorithm>

#include "cpu/leaf_test.h"
#include "cpu_wild_scenes.h"
#include "exact/contact.h"
#include "query/swept_box.h"
#include "support/catch.h"

using namespace radar;
using namespace radar::cpu;

namespace {

exact::Triangle placed(const Mesh& mesh, const Transform& pose, uint32_t triangle) {
  exact::Triangle out;
  for (size_t i = 0; i < 3; ++i)
    out[i] = transformPoint(pose, &mesh.positions[3 * size_t{mesh.indices[3 * triangle + i]}]);
  return out;
}

bool holds(const MeshTree& tree, size_t node, uint32_t triangle) {
  const auto first = tree.order.begin() + tree.below[node].first;
  return std::find(first, first + tree.below[node].count, triangle) != first + tree.below[node].count;
}

/// The sensor of a query and one object.
struct Pair {
  const Mesh &a, &b;
  const Transform &poseA, &poseB;
  Translation motion;
  MeshPlacement placementA, placementB;
  PairMotion pairMotion;
  RelativePlacement fromA, fromB;

  Pair(const Scene::Impl& scene, const Query& query, const Object& object)
      : a(scene.meshes[query.mesh]),
        b(scene.meshes[object.mesh]),
        poseA(query.worldFromMesh),
        poseB(object.worldFromMesh),
        motion(query),
        placementA(a, poseA),
        placementB(b, poseB),
        pairMotion(placementA, placementB, motion, 0, query.distance),
        fromA(MeshAxes(placementA.linear), placementB, pairMotion, -1),
        fromB(MeshAxes(placementB.linear), placementA, pairMotion, 1) {}
};

NodeLanes inAllLanes(const gpu::MeshNode& node) {
  NodeLanes lanes;
  lanes.fill(&node);
  return lanes;
}

/// Checks that all pairs of nodes above the triangles admit contact at `time`, in either precision.
void checkNodes(const Pair& pair, uint32_t triA, uint32_t triB, double time) {
  const NodeTest<float> inFloats(pair.fromA, pair.fromB);
  const NodeTest<double> inDoubles(pair.fromA, pair.fromB);
  for (size_t i = 0; i < pair.a.tree.nodes.size(); ++i) {
    if (!holds(pair.a.tree, i, triA)) continue;
    for (size_t k = 0; k < pair.b.tree.nodes.size(); ++k) {
      if (!holds(pair.b.tree, k, triB)) continue;
      INFO("nodes " << i << " and " << k);
      const gpu::MeshNode &a = pair.a.tree.nodes[i], &b = pair.b.tree.nodes[k];
      TimeSpan span;
      narrow(span, pair.fromA, a, b);
      narrow(span, pair.fromB, b, a);
      REQUIRE(span.from <= time);
      REQUIRE(time <= span.to);
      const auto floats = inFloats(inAllLanes(a), inAllLanes(b));
      const auto doubles = inDoubles(inAllLanes(a), inAllLanes(b));
      REQUIRE(floats.from[kLanes - 1] <= time);
      REQUIRE(time <= floats.to[kLanes - 1]);
      REQUIRE(doubles.from[kLanes - 1] <= time);
      REQUIRE(time <= doubles.to[kLanes - 1]);
    }
  }
}

template <class Real>
void checkLeaves(const Pair& pair, uint32_t triA, uint32_t triB, double time) {
  LeafTest<Real> test(pair.a, pair.b, pair.fromB);
  const auto leafOf = [](const MeshTree& tree, uint32_t triangle) {
    size_t node = 0;
    while ((tree.nodes[node].link & gpu::kLinkLeaf) == 0) {
      node = tree.nodes[node].link;
      if (!holds(tree, node, triangle)) ++node;
    }
    return node;
  };
  const size_t leafA = leafOf(pair.a.tree, triA), leafB = leafOf(pair.b.tree, triB);
  const gpu::MeshNode &a = pair.a.tree.nodes[leafA], &b = pair.b.tree.nodes[leafB];
  const unsigned iA = pair.a.tree.order[a.link & gpu::kLinkItem] == triA ? 0 : 1;
  const unsigned iB = pair.b.tree.order[b.link & gpu::kLinkItem] == triB ? 0 : 1;
  const auto above = static_cast<Real>(time * (1 + 4 * kRounding<Real>));
  const auto below = static_cast<float>(time * (1 - 4 * kRounding<float>));
  for (const float begin : {0.0f, 0.5f * below, below}) {
    for (const Real end : {above, Real(1)}) {
      INFO("from " << begin << " to " << end);
      LeafPairs pairs;
      pairs.add(a, b, begin);
      REQUIRE((test.timesOf(pairs, std::max(Real(begin), end)).possible >> (iA + 2 * iB) & 1) == 1);
    }
  }
}

void check(const wild::Made& made) {
  const Scene::Impl& scene = made.scene.impl();
  for (const Query& query : made.queries) {
    for (ObjectId id = 0; id < made.scene.objectLimit(); ++id) {
      const Pair pair(scene, query, made.scene.object(id));
      const double length = exact::length(pair.motion.direction);
      for (uint32_t triA = 0; triA < pair.a.triangleCount(); ++triA) {
        for (uint32_t triB = 0; triB < pair.b.triangleCount(); ++triB) {
          const auto interval =
              exact::contact(placed(pair.a, pair.poseA, triA), placed(pair.b, pair.poseB, triB), pair.motion.direction);
          if (!interval || exact::sign(interval->last) < 0) continue;
          const bool overlap = exact::sign(interval->first) <= 0;
          if (!overlap && exact::compareToDistance(interval->first, query.distance) > 0) continue;
          const double t = overlap ? 0 : exact::parameter(interval->first) * length;
          INFO("object " << id << ", triangles " << triA << " and " << triB << ", t " << t);
          REQUIRE(t <= pair.pairMotion.span * (1 + 8 * kUnit));
          const double time = pair.pairMotion.timeOf(t) * (1 - 16 * kUnit);
          checkNodes(pair, triA, triB, time);
          checkLeaves<float>(pair, triA, triB, time);
          checkLeaves<double>(pair, triA, triB, time);
        }
      }
    }
  }
}

}  // namespace

TEST_CASE("the bounds on when nodes and triangles touch hold at every scale and in nearly singular poses") {
  for (uint64_t seed = 0; seed < 1500; ++seed) {
    INFO("seed " << seed);
    wild::Random random(5000 + seed);
    wild::Made made;
    wild::make(random, seed % 3 == 0 ? 130 : 2, made);
    check(made);
  }
}
