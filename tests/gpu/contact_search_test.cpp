// The contact search loses nothing with the smallest lists, in the shortest rounds and over very long lists.
#include <cstring>
#include <ostream>
#include <tuple>

#include "support/catch.h"
#include "support/same_bits.h"
#include "support/test_device.h"
#include "sweep/sweeper.h"
#include "workloads/hard_cases.h"
#include "workloads/shapes.h"

namespace radar {

std::ostream& operator<<(std::ostream& out, const SearchRoom& room) {
  return out << "tasks " << room.tasks << ", candidates " << room.candidates << ", unresolved " << room.unresolved
             << ", groups " << room.groups << ", budget " << room.budget << ", width " << room.width << ", queue "
             << room.queue << ", stack " << room.stack;
}

}  // namespace radar

namespace {

using namespace radar;

/// Searches on the device, whatever the size of the batch.
class DeviceSearch {
 public:
  explicit DeviceSearch(const Scene& scene, const SearchRoom& room = {})
      : sweeper_(test::device().impl(), scene, {.cpuBatch = 0}, std::make_shared<GpuScene>(test::device().impl()), room,
                 false) {}

  Answers run(std::span<const Query> queries) {
    Flight flight(queries, false);
    sweeper_.begin(flight, Mode::contact);
    sweeper_.finish(flight);
    return std::move(flight.answers);
  }

 private:
  Sweeper::Impl sweeper_;
};

void checkSame(const Result& a, const Result& b) {
  CAPTURE(a.t, b.t, a.lo, b.lo, a.hi, b.hi, a.object, b.object, a.triB, b.triB, a.triA, b.triA);
  CHECK(test::sameBits(a, b));
}

void checkSame(const std::vector<Result>& a, const std::vector<Result>& b) {
  REQUIRE(a.size() == b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    CAPTURE(i);
    checkSame(a[i], b[i]);
  }
}

/// A family's queries, every fourth of which has `anyHit` set.
struct FamilyQueries {
  FamilyQueries(const char* family, uint32_t count, uint64_t seed, tools::Company company)
      : workload(tools::hardScene(tools::hardFamily(family), seed, 0, count, company)), player(workload) {
    player.show(0);
    queries = tools::queriesOf(workload.queries);
    for (size_t i = 3; i < queries.size(); i += 4) queries[i].anyHit = true;
  }
  tools::Workload workload;
  tools::ScenePlayer player;
  std::vector<Query> queries;
};

Transform at(double x, double y, double z) {
  return {{1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z}};
}

}  // namespace

TEST_CASE("the answers have the same bits with the smallest lists and in the shortest rounds", "[subgroups]") {
  const std::string family = GENERATE("interlocking", "lattice", "soup");
  const FamilyQueries batch(family.c_str(), tools::kIsolatedCases, 1, tools::Company::isolated);
  const std::vector<Result> roomy = DeviceSearch(batch.player.scene()).run(batch.queries).results;
  SearchRoom room = GENERATE(SearchRoom{.tasks = 1}, SearchRoom{.candidates = 1}, SearchRoom{.unresolved = 1},
                             SearchRoom{.groups = 1}, SearchRoom{.budget = 1}, SearchRoom{.budget = 17},
                             SearchRoom{.groups = 3, .budget = 5, .width = 1'000'000},
                             SearchRoom{.tasks = 50, .candidates = 300, .unresolved = 9, .budget = 3});
  std::tie(room.queue, room.stack) = GENERATE(std::pair{0u, 0u}, std::pair{1u, 4u}, std::pair{0u, 7u});
  CAPTURE(family, room);
  DeviceSearch narrow(batch.player.scene(), room);
  const Answers answers = narrow.run(batch.queries);
  checkSame(answers.results, roomy);
  // Only queries that overflow a list go to the CPU, and in some families those with very many unresolved pairs. Rounds
  // that exceed their budget continue in further rounds.
  if (room.candidates == 1) CHECK(answers.stats.cpuQueries > 0);
  if (room.budget == 1 && family == "interlocking") CHECK(answers.stats.submissions > 1);
  const bool few = family == "lattice";
  if (few && room.tasks == 0 && room.candidates == 0 && room.unresolved == 0) CHECK(answers.stats.cpuQueries == 0);
}

namespace {

constexpr uint32_t kTriangles = 70'000;

// A large triangle below many small ones, all of which it meets at the same time if they are level; else the last one
// is the nearest.
struct TrianglesOverhead {
  explicit TrianglesOverhead(bool level) {
    const std::vector<float> small{0, 0, 0, 0.5f, 0, 0, 0, 0.5f, 0}, large{-1, -1, 0, 601, -1, 0, -1, 601, 0};
    const std::vector<uint32_t> corners{0, 1, 2};
    const MeshId triangle = scene.addMesh(small, corners), wing = scene.addMesh(large, corners);
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
  const Answers first = search.run({&triangles.query, 1});
  CHECK(first.stats.submissions > 1);
  const Answers second = search.run({&triangles.query, 1});
  CHECK(second.stats.submissions == 1);
  checkSame(second.results, first.results);
}

TEST_CASE("70,000 candidate pairs, more than lavapipe's limit of loop iterations, are all searched", "[subgroups]") {
  const bool level = GENERATE(true, false);
  CAPTURE(level);
  const TrianglesOverhead triangles(level);
  DeviceSearch search(triangles.scene, {.candidates = 100'000});
  const Result result = search.run({&triangles.query, 1}).results[0];
  CHECK(result.status == Status::hit);
  CHECK(result.t == (level ? 4 : 4.5));
  CHECK(result.object == (level ? 0 : kTriangles - 1));
  checkSame(DeviceSearch(triangles.scene).run({&triangles.query, 1}).results[0], result);
}

TEST_CASE("queries that floats cannot represent are answered on the CPU") {
  Scene scene;
  const tools::MeshData box = tools::makeBox({1, 1, 1});
  const MeshId mesh = scene.addMesh(box.positions, box.indices);
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
