// The device where floats end: distances, scenes and motions of all sizes, far away and in poses that are nearly
// singular.
#include "radar/cpu_sweeper.h"
#include "support/answer.h"
#include "support/catch.h"
#include "support/same_bits.h"
#include "support/test_device.h"
#include "unit/cpu_wild_scenes.h"

namespace {

using namespace radar;

/// Scenes up to 10^`most` in size, half of them with distances of any size.
void make(uint64_t seed, double most, wild::Made& made) {
  wild::Random random(seed);
  wild::make(random, most, made);
  if (seed % 2 == 0) return;
  for (Query& query : made.queries) {
    query.distance = std::min(query.distance * wild::power(random, random.chance(0.5) ? 12 : 60), 1e300);
  }
}

}  // namespace

TEST_CASE("a distance of any size is heeded, the least that doubles hold too") {
  Scene scene;
  const float corners[] = {-1, -1, 0, 1, -1, 0, 0, 1, 0};
  const uint32_t triangle[] = {0, 1, 2};
  const MeshId mesh = scene.addMesh(corners, triangle);
  const double scale = GENERATE(1.0, 0x1p-70, 0x1p70);
  CAPTURE(scale);
  const auto placed = [&](double z) { return Transform{{scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, scale, z * scale}}; };
  for (const double z : {0x1p-140, 1e-30, 0x1p-20, 1.0, 1e11}) scene.addObject({mesh, placed(z), ~0u});
  std::vector<Query> queries;
  for (const double distance : {0.0, 0x1p-1000, 0x1p-200, 0x1p-141, 0x1p-140, 0x1p-139, 1e-31, 1e-30, 1e-29, 1.0, 1e10,
                                1e11, 1e12, 1e40, 1e200}) {
    for (const uint32_t from : {0u, 1u, 2u, 3u, 4u}) {
      Query query{.mesh = mesh, .worldFromMesh = placed(0), .direction = {0, 0, 1}, .distance = distance * scale};
      for (uint32_t nearer = 0; nearer < from; ++nearer) query.exclude.push_back(nearer);
      queries.push_back(query);
    }
  }
  CHECK(test::differenceOf(Sweeper(test::device(), scene, {.cpuBatch = 0}).run(queries),
                           CpuSweeper(scene, 1).run(queries), test::sameButTier) == "");
}

TEST_CASE("in mode sampled what floats cannot hold is refused with a reason, and what is answered is right") {
  const double most = GENERATE(1.0, 20.0, 90.0);
  CAPTURE(most);
  uint64_t answered = 0, refused = 0;
  for (uint64_t seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    wild::Made made;
    make(seed, most, made);
    if (seed % 4 == 0) made.queries[0].direction = {1e300, 5e-324, 0};
    const std::vector<Result> exact = CpuSweeper(made.scene, 1).run(made.queries).results;
    for (Query& query : made.queries) query.resolution = 32;
    Sweeper sweeper(test::device(), made.scene);
    const Answers answers = sweeper.run(made.queries, Mode::sampled);
    const std::vector<Result>& found = answers.results;
    for (size_t i = 0; i < exact.size(); ++i) {
      const std::string reason = test::reasonFor(answers, i);
      CAPTURE(i, reason, exact[i].t, found[i].hi);
      const bool meets = exact[i].status != Status::clear;
      CHECK((found[i].status == Status::invalid) == !reason.empty());
      if (found[i].status == Status::clear) CHECK_FALSE(meets);
      if (found[i].status == Status::hit || found[i].status == Status::overlap) {
        CHECK(meets);
        CHECK(found[i].hi >= exact[i].lo);
      }
      (found[i].status == Status::invalid ? refused : answered) += 1;
    }
  }
  CHECK((most > 80 ? refused : answered) > 100);
  CHECK(test::takeValidationMessages().empty());
}
