// Agents that fly parallel, as a host's shaders ask for them: features that touch or are parallel are the common case
// there.
#include <cmath>

#include "embed/checks.h"
#include "embed/on_device.h"
#include "embed/written_queries.h"
#include "support/buffer_words.h"
#include "support/small_scenes.h"
#include "workloads/random.h"

namespace {

using namespace radar;

constexpr uint32_t kAgents = 1000;
constexpr Capacity kSwarmRoom{.queries = kAgents, .candidates = 1u << 18, .rounds = 64, .unresolvedPairs = 1u << 17};

/// Boxes of a few sizes in one orientation, which fly along their edges; on a grid, many of their faces lie in one
/// plane.
struct Swarm {
  Swarm(uint64_t seed, const tools::Rotation& turn, bool onGrid) {
    tools::Random random(seed);
    const MeshId shapes[] = {test::addBox(scene), test::addBox(scene, 0.5),
                             test::addMesh(scene, tools::makeBox({2, 0.25, 1})),
                             test::addMesh(scene, tools::makeBox({4, 4, 12}))};
    for (uint32_t i = 0; i < kAgents; ++i) {
      tools::Vec3 at = random.inCube(20);
      for (double& x : at) x = onGrid ? std::round(2 * x) / 2 : x;
      Query query{.mesh = shapes[random.oneIn(20) ? 3 : random.below(3)],
                  .worldFromMesh = tools::makePose(turn, {1, 1, 1}, tools::turned(turn, at)),
                  .direction = tools::turned(turn, random.axis()),
                  .distance = random.uniform(2, 12)};
      // With the numbers of a host's shader.
      query = test::queryOf(test::hostQueryOf(query));
      query.exclude = {scene.addObject({.mesh = query.mesh, .worldFromMesh = query.worldFromMesh})};
      queries.push_back(query);
    }
  }
  Scene scene;
  std::vector<Query> queries;
};

/// What shaders see of the answers, and what read() makes of them.
struct Seen {
  std::vector<Result> shaders, read;
};

Seen ask(Swarm& swarm, std::span<const Query> queries, const Capacity& room = kSwarmRoom) {
  const test::Written written(queries);
  Recorder recorder(test::device(), swarm.scene, room);
  Seen seen;
  seen.read = test::execute(test::device(), recorder, HostQueries(written)).results;
  seen.shaders = test::elementsOf<Result>(recorder.results(), 0, queries.size());
  return seen;
}

}  // namespace

TEST_CASE("of agents that fly parallel, shaders see nearly all first contacts, within brackets that hold") {
  tools::Random random(5);
  const tools::Rotation turns[] = {tools::kUpright, random.quarterTurns(), random.rotation()};
  for (const bool onGrid : {false, true}) {
    for (const tools::Rotation& turn : turns) {
      Swarm swarm(random.below(1000), turn, onGrid);
      const Seen seen = ask(swarm, swarm.queries);
      const std::vector<Result> expected = test::expectedOf(swarm.scene, swarm.queries);
      test::checkSame(seen.read, expected);
      uint32_t contacts = 0, undecided = 0, wide = 0, others = 0;
      for (uint32_t i = 0; i < kAgents; ++i) {
        const Result &found = seen.shaders[i], &exact = expected[i];
        CAPTURE(onGrid, i, found.status, found.lo, found.t, found.hi, exact.status, exact.t);
        REQUIRE((found.status == exact.status || found.status == Status::undecided));
        // At the start, who touches and who crosses is told apart by read().
        if (found.status == Status::clear || exact.status == Status::overlap) continue;
        ++contacts;
        undecided += found.status == Status::undecided;
        CHECK(found.lo <= exact.t);
        if (found.flags == Flag::unresolved) CHECK(found.t == found.lo);
        if (found.status == Status::hit) {
          CHECK(exact.t <= found.hi);
          wide += found.hi - found.lo > 1e-12 * found.hi;
          others += found.object != exact.object;
        }
      }
      CAPTURE(contacts, undecided, wide, others);
      CHECK(contacts > 80);
      if (!test::device().doubles()) continue;
      if (!onGrid) CHECK(undecided + others == 0);
      if (!onGrid) CHECK(100 * wide < contacts);
      // Of many on a grid, sides slide along each other: rounding cannot tell that from a miss.
      CHECK(3 * undecided < contacts);
    }
  }
}

TEST_CASE("what shaders see of open answers does not depend on the course of the search") {
  for (const bool onGrid : {false, true}) {
    Swarm swarm(3, tools::kUpright, onGrid);
    const std::vector<Result> found = ask(swarm, swarm.queries).shaders;
    std::vector<Query> reversed(swarm.queries.rbegin(), swarm.queries.rend());
    std::vector<Result> again = ask(swarm, reversed).shaders;
    std::reverse(again.begin(), again.end());
    test::checkSame(again, found);
    for (uint32_t i = 0; i < 50; ++i) test::checkSame(ask(swarm, {&swarm.queries[i], 1}).shaders, {&found[i], 1});
  }
}
