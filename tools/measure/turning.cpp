#include "measure/turning.h"

#include <cmath>

#include "measure/timing.h"
#include "query/chain_motion.h"
#include "query/turning.h"
#include "radar/cpu_sweeper.h"
#include "workloads/arm.h"
#include "workloads/generate.h"
#include "workloads/random.h"

namespace radar::tools {

namespace {

constexpr double kTolerance = 1e-6;  // metres: where advancement says that links touch
constexpr uint32_t kSteps = 64;      // of a sampler

void addRow(Json& report, const std::string& workload, const std::string& method, size_t queries, double seconds,
            double times, Json touching) {
  partOf(report, "turns", "Section turns, microseconds a query, one thread")["rows"].push_back(
      {{"workload", workload},
       {"method", method},
       {"queries", queries},
       {"us", 1e6 * seconds / static_cast<double>(queries)},
       {"times_the_first", times},
       {"touching", std::move(touching)}});
}

template <class Run>
double medianTime(Extent extent, const Run& run) {
  std::vector<double> laps;
  run();
  for (uint32_t i = 0; i < (extent == Extent::full ? 7u : 1u); ++i) laps.push_back(lapOf(run).wall);
  return median(laps);
}

template <class Answers, class Of>
size_t touching(const Answers& answers, const Of& result) {
  size_t count = 0;
  for (const auto& answer : answers) count += result(answer).status != Status::clear;
  return count;
}

/// The first of some queries that turn, asked of FCL, too.
void turnWithFcl(std::vector<Query> queries, const std::string& name, Extent extent, CpuSweeper& sweeper,
                 RigidBodies& bodies, Json& report) {
  queries.resize(std::min<size_t>(queries.size(), extent == Extent::full ? 64 : 4));
  Answers answers;
  const double ours = medianTime(extent, [&] { sweeper.run(queries, answers); });
  addRow(report, name, "turning by 30 degrees, as FCL is asked", queries.size(), ours, 1,
         touching(answers.results, [](const Result& r) { return r; }));
  const auto ask = [&](const std::string& method, const std::function<bool(const Query&, const Turning&)>& meets) {
    size_t touched = 0;
    const auto all = [&] {
      for (const Query& query : queries) touched += meets(query, Turning(query));
    };
    const double theirs = lapOf(all).wall;
    addRow(report, name, method, queries.size(), theirs, theirs / ours, touched);
  };
  const auto at = [](const Query& query, const Turning& turning, double s) {
    return turning.pose(query.worldFromMesh, s, turning.way());
  };
  ask(print("turning by 30 degrees, FCL's continuous mode, %u steps", kSteps),
      [&](const Query& query, const Turning& turning) {
        return bodies.continuous({query.mesh, query.worldFromMesh}, at(query, turning, 1), kSteps).has_value();
      });
  ask(print("turning by 30 degrees, FCL at %u steps", kSteps), [&](const Query& query, const Turning& turning) {
    const auto placed = [&](double s) { return std::vector{Instance{query.mesh, at(query, turning, s)}}; };
    return bodies.stepped(kSteps, placed).has_value();
  });
}

void turnBoxes(SensorShape shape, const std::string& name, Extent extent, MakeRigidBodies* makeBodies, Json& report) {
  const Workload workload =
      makeWorkload(Table1{.boxes = 10'000, .sensors = extent == Extent::full ? 2'048u : 64u, .shape = shape});
  ScenePlayer player(workload);
  player.show(0);
  CpuSweeper sweeper(player.scene(), 1);
  Random random(1);
  double first = 0;
  for (const double degrees : {0.0, 30.0, 90.0}) {
    std::vector<Query> queries(workload.queries.begin(), workload.queries.end());
    for (Query& query : queries) {
      const Vec3& way = query.direction;
      const double share = query.distance / std::hypot(way[0], way[1], way[2]);
      query.motion = Vec3{share * way[0], share * way[1], share * way[2]};
      query.direction = {};
      query.distance = 0;
      // About its origin, which is amid it.
      if (degrees > 0) {
        const Transform& pose = query.worldFromMesh;
        query.turn = Turn{random.direction(), degrees * std::acos(-1.0) / 180, {pose.m[3], pose.m[7], pose.m[11]}};
      }
    }
    Answers answers;
    const double seconds = medianTime(extent, [&] { sweeper.run(queries, answers); });
    if (degrees == 0) first = seconds;
    addRow(report, name, degrees == 0 ? "straight" : "turning by " + print("%g", degrees) + " degrees", queries.size(),
           seconds, seconds / first, touching(answers.results, [](const Result& r) { return r; }));
    const std::unique_ptr<RigidBodies> bodies = degrees == 30 ? makeBodies(workload) : nullptr;
    if (bodies != nullptr) turnWithFcl(queries, name, extent, sweeper, *bodies, report);
  }
}

/// Goes on by as much as no link can move within the least distance.
bool advance(const ArmCell& cell, const ChainQuery& query, RigidBodies& bodies) {
  const ChainMotion motion(cell.chain, query);
  double s = 0;
  while (s < 1) {
    double step = 1;
    for (uint32_t link = 0; link < cell.chain.links.size(); ++link) {
      const LinkWay way = LinkWay::between(cell.chain, kNone, link);
      const LinkMesh& mesh = cell.chain.links[link].meshes[0];
      const double length = 2 * mesh.linkFromMesh.m[11];
      const double near = bodies.distance({mesh.mesh, product(motion.pose(way, s), mesh.linkFromMesh)});
      if (near <= kTolerance) return true;
      step = std::min(step, near / motion.boundsFor(way, std::hypot(length, 0.1), 0).speed);
    }
    s += step;
  }
  return false;
}

void moveArm(double turn, Extent extent, MakeRigidBodies* makeBodies, Json& report) {
  const ArmCell cell = makeArmCell({.motions = extent == Extent::full ? 4'000u : 40u, .turn = turn});
  ScenePlayer player(cell.workload);
  player.show(0);
  ChainSweeper sweeper(player.scene(), cell.chain, 1);
  std::vector<ChainQuery> all, free;
  for (const std::array<double, 12>& motion : cell.motions) {
    const std::span<const double, 12> both(motion);
    all.push_back({.from = both.first(6), .to = both.last(6)});
  }
  const std::string name = "arm, up to " + print("%g", turn) + " rad a joint";
  std::vector<ChainResult> results;
  const auto isTouching = [](const ChainResult& result) { return result.contact; };
  const double seconds = medianTime(extent, [&] { results = sweeper.run(all); });
  addRow(report, name, "all", all.size(), seconds, 1, touching(results, isTouching));
  for (size_t i = 0; i < all.size(); ++i) {
    if (results[i].contact.status == Status::clear) free.push_back(all[i]);
  }
  if (free.empty()) return;
  const double ours = medianTime(extent, [&] { results = sweeper.run(free); }) / static_cast<double>(free.size());
  addRow(report, name, "free", free.size(), ours * static_cast<double>(free.size()), 1, touching(results, isTouching));
  ChainSweeper onAll(player.scene(), cell.chain);
  const double together = medianTime(extent, [&] { results = onAll.run(free); });
  addRow(report, name, "free, on all threads", free.size(), together,
         together / static_cast<double>(free.size()) / ours, touching(results, isTouching));
  const std::unique_ptr<RigidBodies> bodies = makeBodies(cell.workload);
  if (bodies == nullptr) return;
  // Without the links' conflicts with each other, which ours include.
  free.resize(std::min<size_t>(free.size(), extent == Extent::full ? 50 : 2));
  const auto ask = [&](const std::string& method, const std::function<bool(const ChainQuery&)>& meets) {
    size_t touched = 0;
    const auto everything = [&] {
      for (const ChainQuery& query : free) touched += meets(query);
    };
    const double theirs = lapOf(everything).wall;
    addRow(report, name, method, free.size(), theirs, theirs / static_cast<double>(free.size()) / ours, touched);
  };
  ask("free, by FCL's distances", [&](const ChainQuery& query) { return advance(cell, query, *bodies); });
  ask(print("free, by FCL at %u steps", kSteps), [&](const ChainQuery& query) {
    const ChainMotion motion(cell.chain, query);
    const auto placed = [&](double s) {
      std::vector<Instance> links;
      for (uint32_t link = 0; link < cell.chain.links.size(); ++link) {
        const LinkMesh& mesh = cell.chain.links[link].meshes[0];
        links.push_back(
            {mesh.mesh, product(motion.pose(LinkWay::between(cell.chain, kNone, link), s), mesh.linkFromMesh)});
      }
      return links;
    };
    return bodies->stepped(kSteps, placed).has_value();
  });
}

}  // namespace

void measureTurns(Extent extent, MakeRigidBodies* makeBodies, Json& report) {
  turnBoxes(SensorShape::box, "boxes", extent, makeBodies, report);
  turnBoxes(SensorShape::teapot, "teapots", extent, makeBodies, report);
  for (const double turn : {0.2, 1.0}) moveArm(turn, extent, makeBodies, report);
  partOf(report, "turns")["state"] = "done";
}

}  // namespace radar::tools
