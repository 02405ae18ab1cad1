// The contact search loses nothing with the smallest lists, in the shortest rounds and over very long lists.
#include <algorithm>
#include <cstring>
#include <ostream>
#include <tuple>

#include "contact/submitter.h"
#include "radar/cpu_sweeper.h"
#include "support/catch.h"
#include "support/same_bits.h"
#include "support/test_device.h"
#include "support/world.h"
#include "sweep/sweeper.h"
#include "workloads/generate.h"
#include "workloads/hard_cases.h"
#include "workloads/interlocking.h"
#include "workloads/same_answer.h"
#include "workloads/shapes.h"

namespace radar {

std::ostream& operator<<(std::ostream& out, const SearchTuning& room) {
  return out << "tasks " << room.tasks << ", candidates " << room.candidates << ", unresolved " << room.unresolved
             << ", groups " << room.groups << ", budget " << room.budget << ", width " << room.width << ", queue "
             << room.queue << ", stack " << room.stack << ", searches " << room.searches << ", rounds " << room.rounds
             << ", split " << room.split << ", steps " << room.objectSteps << " and " << room.nodeSteps << ", few "
             << room.few << ", leaf batch " << room.leafBatch;
}

}  // namespace radar

namespace {

using namespace radar;
using test::add;
using test::at;
using test::differenceOf;

/// Searches on the device, whatever the size of the batch.
class DeviceSearch {
 public:
  explicit DeviceSearch(const Scene& scene, const SearchTuning& room = {})
      : sweeper_(test::device().impl(), scene, {.cpuBatch = 0}, std::make_shared<GpuScene>(test::device().impl()), room,
                 false) {}

  Answers run(std::span<const Query> queries, const std::stop_token& stop = {}) {
    Flight flight(queries, false, stop);
    sweeper_.begin(flight, Mode::contact);
    sweeper_.finish(flight);
    return std::move(flight.answers);
  }

 private:
  Sweeper::Impl sweeper_;
};

/// A family's queries, every fourth of which has `anyHit` set.
test::Case familyOf(const std::string& name) {
  test::Case out =
      test::caseOf(tools::hardScene(tools::hardFamily(name), 1, 0, tools::kIsolatedCases, tools::Company::isolated));
  for (size_t i = 3; i < out.queries.size(); i += 4) out.queries[i].anyHit = true;
  return out;
}

}  // namespace

TEST_CASE("the answers have the same bits with the smallest lists and in the shortest rounds", "[subgroups]") {
  const std::string family = GENERATE("interlocking", "lattice", "soup");
  const test::Case batch = familyOf(family);
  const std::vector<Result> roomy = DeviceSearch(batch.scene).run(batch.queries).results;
  SearchTuning room = GENERATE(SearchTuning{.tasks = 1}, SearchTuning{.candidates = 1}, SearchTuning{.unresolved = 1},
                               SearchTuning{.groups = 1}, SearchTuning{.rounds = 2, .budget = 1},
                               SearchTuning{.budget = 17}, SearchTuning{.groups = 3, .budget = 5, .width = 1'000'000},
                               SearchTuning{.tasks = 50, .candidates = 300, .unresolved = 9, .budget = 3});
  std::tie(room.queue, room.stack) = GENERATE(std::pair{0u, 0u}, std::pair{1u, 4u}, std::pair{0u, 7u});
  CAPTURE(family, room);
  DeviceSearch narrow(batch.scene, room);
  const Answers answers = narrow.run(batch.queries);
  CHECK(differenceOf(answers.results, roomy) == "");
  // Only queries that overflow a list go to the CPU, and in some families those with very many unresolved pairs. Rounds
  // that exceed their budget continue in further rounds.
  if (room.candidates == 1) CHECK(answers.stats.cpuQueries > 0);
  // Lavapipe's few workgroups do; a GPU's may end in the first.
  if (test::isLavapipe() && room.budget == 1 && family == "interlocking") CHECK(answers.stats.submissions > 1);
  const bool few = family == "lattice";
  if (few && room.tasks == 0 && room.candidates == 0 && room.unresolved == 0) CHECK(answers.stats.cpuQueries == 0);
}

TEST_CASE("the answers have the same bits with the least and the most of every number that shapes the search",
          "[subgroups]") {
  const std::string family = GENERATE("interlocking", "soup");
  const test::Case batch = familyOf(family);
  const std::vector<Result> usual = DeviceSearch(batch.scene).run(batch.queries).results;
  const SearchTuning tuning =
      GENERATE(SearchTuning{.objectSteps = 1, .nodeSteps = 1}, SearchTuning{.objectSteps = 200, .nodeSteps = 300},
               SearchTuning{.few = 1}, SearchTuning{.few = 1000}, SearchTuning{.leafBatch = 1},
               SearchTuning{.leafBatch = 1'000'000}, SearchTuning{.width = 1'000'000, .split = 1},
               SearchTuning{.width = 1'000'000, .split = 10'000}, SearchTuning{.rounds = 1, .budget = 40},
               SearchTuning{.rounds = 1000, .budget = 40}, SearchTuning{.searches = 3});
  CAPTURE(family, tuning);
  CHECK(differenceOf(DeviceSearch(batch.scene, tuning).run(batch.queries).results, usual) == "");
}

TEST_CASE("of a batch that is given up half-way, memory that had other answers keeps none of them") {
  const test::Case asked =
      test::caseOf(tools::makeWorkload(tools::Table1{.boxes = 1000, .sensors = 600, .shape = tools::SensorShape::box}));
  const std::vector<Query> others(asked.queries.rbegin(), asked.queries.rend());
  const std::vector<Result> right = DeviceSearch(asked.scene).run(asked.queries).results;
  std::vector<SearchNeeds> needs(asked.queries.size());
  requireValid(asked.queries, asked.scene, Mode::contact, false, 1, needs);
  Sweeper::Impl sweeper(test::device().impl(), asked.scene, {.cpuBatch = 0},
                        std::make_shared<GpuScene>(test::device().impl()), {.searches = 100}, false);
  Flight flight(asked.queries, needs, false, {}, DeviceSearch(asked.scene).run(others));
  sweeper.begin(flight, Mode::contact);
  sweeper.abandon(flight);
  size_t answered = 0;
  for (size_t i = 0; i < right.size(); ++i) {
    const Result& result = flight.answers.results[i];
    answered += result.status != Status::invalid;
    CHECK(test::sameBits(result, result.status != Status::invalid ? right[i] : Result()));
  }
  CHECK(answered >= 100);
  CHECK(answered < right.size());
}

TEST_CASE("submissions record as many rounds as batches have taken lately, and all once these do not suffice") {
  Rounds rounds(8, true);
  for (const uint32_t expected : {6u, 4u, 2u, 2u}) {
    rounds.took(1);
    CHECK(rounds.count() == expected);
  }
  rounds.took(3);
  CHECK(rounds.count() == 8);
  rounds.took(5);
  CHECK(rounds.count() == 6);
  rounds.took(6);
  CHECK(rounds.count() == 6);
  Rounds fixed(4, false);
  fixed.took(1);
  CHECK(fixed.count() == 4);
  fixed.took(5);
  CHECK(fixed.count() == 4);
}

TEST_CASE("batches that need more rounds than those before them take further submissions, with the same answers") {
  const test::Case heavy = test::caseOf(
      tools::makeWorkload(tools::InterlockingPairs{.kind = tools::Interlocking::ringOnPeg, .sensors = 32}));
  const std::vector<Result> expected = DeviceSearch(heavy.scene).run(heavy.queries).results;
  DeviceSearch search(heavy.scene);
  const Query away{
      .mesh = heavy.queries[0].mesh, .worldFromMesh = at(0, 0, 1e6), .direction = {0, 0, 1}, .distance = 1};
  for (int i = 0; i < 4; ++i) CHECK(search.run({&away, 1}).results[0].status == Status::clear);
  CHECK(differenceOf(search.run(heavy.queries).results, expected) == "");
}

TEST_CASE("workgroups that could spill more than there is room for spill less, and no task is lost", "[subgroups]") {
  // Rings on pegs: very many tasks, as each is split early.
  const test::Case batch = test::caseOf(
      tools::makeWorkload(tools::InterlockingPairs{.kind = tools::Interlocking::ringOnPeg, .sensors = 32}));
  const Answers roomy = DeviceSearch(batch.scene, {.candidates = 1u << 17}).run(batch.queries);
  // A lane has up to 41 entries. There is room for those of a few workgroups, and 64 want to take part.
  const uint32_t all = 41 * test::device().impl().subgroupSize;
  for (const uint32_t groups : {2u, 8u}) {
    CAPTURE(groups);
    const SearchTuning room{.tasks = groups * all, .candidates = 1u << 17, .groups = 64, .width = 1'000'000};
    const Answers answers = DeviceSearch(batch.scene, room).run(batch.queries);
    CHECK(differenceOf(answers.results, roomy.results) == "");
    CHECK(answers.stats.cpuQueries == roomy.stats.cpuQueries);
  }
}

namespace {

constexpr uint32_t kTriangles = 70'000;

// A large triangle below many small ones, all of which it meets at the same time if they are level; else the last one
// is the nearest.
struct TrianglesOverhead {
  explicit TrianglesOverhead(bool level) {
    const MeshId triangle = add(scene, {"", {0, 0, 0, 0.5f, 0, 0, 0, 0.5f, 0}, {0, 1, 2}}),
                 wing = add(scene, {"", {-1, -1, 0, 601, -1, 0, -1, 601, 0}, {0, 1, 2}});
    constexpr uint32_t kSide = 265;
    tools::Random random(6);
    for (uint32_t i = 0; i < kTriangles; ++i) {
      const double height = level ? 4 : random.uniform(5, 9);
      const uint32_t column = i % kSide, row = i / kSide;
      scene.addObject({triangle, at(column, row, height), ~0u});
    }
    if (!level) scene.setTransform(kTriangles - 1, at(1, 2, 4.5));
    query = {.mesh = wing, .worldFromMesh = at(0, 0, 0), .direction = {0, 0, 2}, .distance = 20};
  }
  Scene scene;
  Query query;
};

}  // namespace

TEST_CASE("a batch with too many candidates for its lists is searched again, in larger ones") {
  const TrianglesOverhead triangles(true);
  DeviceSearch search(triangles.scene);
  const Answers first = search.run({&triangles.query, 1}), second = search.run({&triangles.query, 1});
  // A GPU's first lists may hold them, and there rounds are brief.
  if (test::isLavapipe()) {
    CHECK(first.stats.submissions > 1);
    CHECK(second.stats.submissions == 1);
  }
  CHECK(differenceOf(second.results, first.results) == "");
}

TEST_CASE("70,000 candidate pairs, more than lavapipe's limit of loop iterations, are all searched", "[subgroups]") {
  const bool level = GENERATE(true, false);
  CAPTURE(level);
  const TrianglesOverhead triangles(level);
  DeviceSearch search(triangles.scene, {.candidates = 100'000});
  const std::vector<Result> results = search.run({&triangles.query, 1}).results;
  CHECK(results[0].status == Status::hit);
  CHECK(results[0].t == (level ? 4 : 4.5));
  CHECK(results[0].object == (level ? 0 : kTriangles - 1));
  CHECK(differenceOf(DeviceSearch(triangles.scene).run({&triangles.query, 1}).results, results) == "");
}

TEST_CASE("a device whose driver ends loops of the search early is given up, and the CPU answers", "[subgroups]") {
  const test::Case batch = test::caseOf(tools::makeWorkload(tools::Soups{.objects = 300, .sensors = 1024}));
  const std::vector<Result> truth = DeviceSearch(batch.scene, {.budget = 1000}).run(batch.queries).results;
  // Two workgroups do everything, in one round if they have the budget. Not all releases of lavapipe let them.
  const uint32_t budget = GENERATE(0u, 1'000'000'000u);
  CAPTURE(budget);
  const Answers found = DeviceSearch(batch.scene, {.groups = 2, .budget = budget}).run(batch.queries);
  CHECK(differenceOf(found.results, truth) == "");
  if (budget == 0) CHECK(found.stats.lost.empty());
  if (!found.stats.lost.empty()) CHECK(found.stats.lost == "the driver ends loops of the contact search early");
}
TEST_CASE("a device that takes long is given less at a time, and another ever more", "[subgroups]") {
  Pace slow(true, 40'000), quick(true, 40'000), calm(false, 40'000);
  for (int i = 0; i < 20; ++i) {
    slow.took(3 * Pace::kWantedMs);
    quick.took(Pace::kWantedMs / 3);
    calm.took(3 * Pace::kWantedMs);
  }
  CHECK(slow.budget() == Pace::kLeast);
  CHECK(quick.budget() == 40'000);
  CHECK(calm.budget() == 40'000);
  slow.took(0);
  CHECK(slow.budget() == 2 * Pace::kLeast);

  const TrianglesOverhead triangles(true);
  // A second between any two looks at the clock, and none.
  std::vector<uint32_t> submissions;
  for (const auto tick : {std::chrono::seconds(1), std::chrono::seconds(0)}) {
    std::chrono::steady_clock::time_point time;
    DeviceSearch search(triangles.scene, {.candidates = 100'000, .groups = 1, .now = [&] { return time += tick; }});
    const Answers answers = search.run({&triangles.query, 1});
    CHECK(answers.results[0].status == Status::hit);
    CHECK(answers.results[0].object == 0);
    submissions.push_back(answers.stats.submissions);
  }
  CAPTURE(submissions);
  // How many more depends on how much a round of so many iterations does: on lavapipe little.
  CHECK(submissions[0] > (test::isLavapipe() ? 2 : 1) * submissions[1]);
}

TEST_CASE("a search on a device whose stop is requested submits no further round, and the next one is answered",
          "[subgroups]") {
  const TrianglesOverhead triangles(true);
  std::stop_source stop;
  int looks = 0;
  // At the clock, once before and once after every round but the first.
  const auto look = [&] {
    if (++looks == 4) stop.request_stop();
    return std::chrono::steady_clock::time_point(std::chrono::seconds(looks));
  };
  DeviceSearch search(triangles.scene, {.candidates = 100'000, .groups = 1, .now = look});
  const std::vector<Query> queries(3, triangles.query);
  const Answers stopped = search.run(queries, stop.get_token());
  CHECK(looks == 4);
  for (size_t i = 0; i < queries.size(); ++i) {
    CHECK(stopped.results[i].status == Status::invalid);
    CHECK(stopped.reasons.at(i) == "cancelled");
  }
  CHECK(differenceOf(search.run(queries).results, DeviceSearch(triangles.scene).run(queries).results) == "");
}

TEST_CASE("queries that floats cannot represent are answered on the CPU") {
  Scene scene;
  const MeshId mesh = add(scene, tools::makeBox({1, 1, 1}));
  const double size = GENERATE(1e-40, 1.0, 1e30, 1e80);
  CAPTURE(size);
  const auto placed = [&](double x) { return Transform{{size, 0, 0, x * size, 0, size, 0, 0, 0, 0, size, 0}}; };
  scene.addObject({mesh, placed(3), ~0u});
  const Query query{.mesh = mesh, .worldFromMesh = placed(0), .direction = {1, 0, 0}, .distance = 5 * size};
  DeviceSearch search(scene);
  const Answers answers = search.run({&query, 1});
  CHECK(answers.results[0].status == Status::hit);
  CHECK(answers.results[0].t == Approx(2 * size));
  CHECK(answers.stats.cpuQueries == (size == 1 ? 0 : 1));
}

TEST_CASE("a clearance as large as the shapes, or larger, opens few pairs of triangles on the device") {
  Scene scene;
  const MeshId shape = add(scene, tools::makeTorus(1, 0.4, 60, 30));
  scene.addObject({shape, at(0, 0, 0)});
  Query query{.mesh = shape, .worldFromMesh = at(-30, -30.1, -30.2), .direction = {1, 1, 1}, .distance = 90};
  query.clearance = GENERATE(0.1, 3.0, 12.0);
  DeviceSearch search(scene);
  const Answers answers = search.run({&query, 1});
  CAPTURE(query.clearance, answers.stats.pairs);
  CHECK(answers.results[0].status == Status::hit);
  CHECK(answers.stats.cpuQueries == 0);
  // Of 13 million.
  CHECK(answers.stats.pairs < 5'000);
  CHECK(differenceOf(answers.results, CpuSweeper(scene, 1).run({&query, 1}).results, tools::sameAnswer) == "");
}
