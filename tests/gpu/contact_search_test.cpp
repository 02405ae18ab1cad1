// The contact tier's search with its culling and rounds switched off, with the least room, and over long lists.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "gpu/device.h"
#include "support/test_device.h"
#include "sweep/contact_decode.h"
#include "sweep/decode.h"
#include "workloads/families.h"
#include "workloads/shapes.h"

namespace {

using namespace radar;

/// Every cluster of the sensor and of every object that takes part, placed so loosely that each box holds everything:
/// all pairs of clusters have gap 0, which leaves one round, and every pair of triangles is solved.
ContactPlan everything(const Query& query, const Scene::Impl& scene, const Hierarchy& hierarchy) {
  ContactPlan plan = planContact(query, scene, hierarchy);
  plan.placements.clear();
  plan.sensor.clear();
  plan.scene.clear();
  const auto add = [&](MeshId mesh, ObjectId object, std::vector<gpu::ClusterRef>& refs) {
    const auto placement = static_cast<uint32_t>(plan.placements.size());
    plan.placements.push_back({.frameFromMesh = {}, .error = 1e15f, .mesh = mesh, .object = object, .moved = kNone});
    const std::vector<ClusterNode>& nodes = scene.meshes[mesh].clusters.nodes;
    for (uint32_t i = 0; i < nodes.size(); ++i) {
      if (nodes[i].count != 0) refs.push_back({placement, i});
    }
  };
  add(query.mesh, kNone, plan.sensor);
  for (ObjectId id = 0; id < scene.objects.size(); ++id) add(scene.objects[id].object.mesh, id, plan.scene);
  return plan;
}

/// A search of its own, over the plans it is given.
class Searching {
 public:
  Searching(const Scene& scene, const ContactRoom& room)
      : scene_(scene), resident_(test::device().impl()), recorder_(test::device().impl(), resident_, false, room) {
    hierarchy_.update(scene.impl());
  }

  std::vector<Result> run(const std::vector<Query>& queries, bool cull) {
    std::vector<ContactPlan> plans;
    for (const Query& query : queries) {
      plans.push_back(cull ? planContact(query, scene_.impl(), hierarchy_)
                           : everything(query, scene_.impl(), hierarchy_));
    }
    std::vector<Result> results(queries.size(), decodeClear());
    std::vector<const ContactPlan*> asked;
    std::vector<size_t> which;
    for (size_t i = 0; i < plans.size(); ++i) {
      if (plans[i].scene.empty()) continue;
      asked.push_back(&plans[i]);
      which.push_back(i);
    }
    std::vector<StageTime> stages;
    recorder_.submit(asked, scene_.impl());
    const auto refused = recorder_.collect(asked, scene_.impl(), stages, [&](size_t i, const Found& found) {
      solved += found.state.solved;
      most = std::max(most, found.state.pairCount);
      uint64_t cpuPairs = 0;
      results[which[i]] = decodeContact(found, queries[which[i]], cpuPairs);
    });
    CHECK(refused.empty());
    return results;
  }

  uint64_t solved = 0;
  uint32_t most = 0;  ///< cluster pairs of one search

 private:
  const Scene& scene_;
  ResidentScene resident_;
  ContactRecorder recorder_;
  Hierarchy hierarchy_;
};

/// Which tier saw that there is nothing may differ.
void checkSame(Result a, Result b) {
  if (a.status == Status::clear && b.status == Status::clear) {
    a.tier = b.tier;
    a.detected = b.detected;
  }
  CAPTURE(a.t, b.t, a.lo, b.lo, a.hi, b.hi, a.object, b.object, a.triB, b.triB, a.triA, b.triA);
  CHECK(std::memcmp(&a, &b, sizeof a) == 0);
}

std::vector<Query> show(const tools::Workload& workload, tools::ScenePlayer& player) {
  player.show(0);
  std::vector<Query> queries;
  for (const tools::QuerySpec& spec : workload.queries) queries.push_back(tools::toQuery(spec, Mode::contact));
  return queries;
}

Pose at(double x, double y, double z) {
  return {{1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z}};
}

}  // namespace

TEST_CASE(
    "with culling and rounds switched off, brute force over all pairs of triangles, the answers have the same bits") {
  const tools::Family family = GENERATE(tools::Family::convex, tools::Family::open, tools::Family::soup,
                                        tools::Family::lattice, tools::Family::touching, tools::Family::directions);
  CAPTURE(tools::nameOf(family));
  tools::Workload workload = tools::makeWorkload(tools::FamilyScene{.family = family, .queries = 12, .seed = 2});
  workload.scenes[0].instances.resize(12);
  tools::ScenePlayer player(workload);
  const std::vector<Query> queries = show(workload, player);
  Sweeper sweeper(test::device(), player.scene());
  const std::vector<Result> culled = sweeper.run(queries);
  Searching searching(player.scene(), {.way = ContactWay::direct});
  const std::vector<Result> all = searching.run(queries, false);
  uint64_t pairs = 0, contacts = 0;
  for (size_t i = 0; i < queries.size(); ++i) {
    CAPTURE(i);
    checkSame(all[i], culled[i]);
    contacts += all[i].status != Status::clear;
    for (ObjectId id = 0; id < player.scene().objectLimit(); ++id) {
      pairs += uint64_t{player.scene().mesh(queries[i].mesh).triangleCount()} *
               player.scene().mesh(player.scene().object(id).mesh).triangleCount();
    }
  }
  CHECK(searching.solved == pairs);
  CHECK(contacts >= 1);
}

TEST_CASE("with the least room for pairs and contenders, and in the shortest runs, the answers have the same bits") {
  const ContactRoom room =
      GENERATE(ContactRoom{.pairs = 1, .pairsPerCluster = 0}, ContactRoom{.contenders = 1}, ContactRoom{.run = 1},
               ContactRoom{.run = 17}, ContactRoom{.pairs = 1, .pairsPerCluster = 0, .contenders = 1, .run = 1},
               ContactRoom{.contenders = 1, .way = ContactWay::masked},
               ContactRoom{.pairs = 1, .pairsPerCluster = 0, .contenders = 1, .run = 1, .way = ContactWay::masked});
  const tools::Family family = GENERATE(tools::Family::interlocking, tools::Family::lattice);
  CAPTURE(tools::nameOf(family), room.pairs, room.contenders, room.run);
  const tools::Workload workload = tools::makeWorkload(tools::FamilyScene{.family = family, .queries = 32, .seed = 4});
  tools::ScenePlayer player(workload);
  const std::vector<Query> queries = show(workload, player);
  Sweeper sweeper(test::device(), player.scene());
  const std::vector<Result> roomy = sweeper.run(queries);
  Searching searching(player.scene(), room);
  const std::vector<Result> narrow = searching.run(queries, true);
  for (size_t i = 0; i < queries.size(); ++i) {
    CAPTURE(i);
    checkSame(narrow[i], roomy[i]);
  }
  CHECK(searching.most > 1);
}

TEST_CASE("a list of 70,000 cluster pairs, longer than a loop may be on lavapipe, is searched to its end") {
  Scene scene;
  const std::vector<float> small{0, 0, 0, 0.5f, 0, 0, 0, 0.5f, 0}, large{-1, -1, 0, 601, -1, 0, -1, 601, 0};
  const std::vector<uint32_t> corners{0, 1, 2};
  const MeshId triangle = scene.addMesh(small, corners), wing = scene.addMesh(large, corners);
  constexpr uint32_t kCount = 70'000, kSide = 265;
  const bool level = GENERATE(true, false);
  CAPTURE(level);
  tools::Random random(6);
  for (uint32_t i = 0; i < kCount; ++i) {
    const double height = level ? 4 : random.uniform(5, 9);
    scene.addObject({triangle, at(i % kSide, double(i / kSide), height), ~0u});
  }
  // The last is the nearest, if not all are alike.
  if (!level) scene.setPose(kCount - 1, at(1, 2, 4.5));
  const std::vector<Query> queries{
      {.mesh = wing, .worldFromMesh = at(0, 0, 0), .direction = {0, 0, 2}, .distance = 20}};
  Searching searching(scene, {});
  const Result result = searching.run(queries, true)[0];
  CHECK(searching.most == kCount);
  CHECK(result.status == Status::hit);
  CHECK(result.t == (level ? 4 : 4.5));
  CHECK(result.object == (level ? 0 : kCount - 1));
  Sweeper sweeper(test::device(), scene);
  checkSame(sweeper.run(queries)[0], result);
}
