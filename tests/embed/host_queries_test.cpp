// Queries that a host's shaders write: their answers have the bits of a sweeper's for the same numbers.
#include <cmath>
#include <limits>
#include <random>

#include "embed/checks.h"
#include "embed/renderer.h"
#include "embed/written_queries.h"
#include "fuzz/check_recorded.h"
#include "support/buffer_words.h"
#include "support/small_scenes.h"
#include "unit/cpu_wild_scenes.h"

namespace {

using namespace radar;
using namespace test;

/// What became of written queries, and how many of them are out of range only for the shader.
struct Tally : fuzz::Outcomes {
  size_t stricter = 0;
};

/// Compares the answers with the CPU's. A query that lacks room must do so when the CPU encodes it, too, unless
/// `isCoarse`: without doubles, a mesh far from its own origin is placed coarsely.
void compare(const Scene& scene, Recorder& recorder, const std::vector<HostQuery>& queries, bool isCoarse,
             Tally& tally) {
  const Written written(queries);
  const Answers got = execute(test::device(), recorder, HostQueries(written));
  fuzz::checkRecorded(written.same, got, CpuSweeper(scene, 1).run(written.same), tally);
  const std::vector<Result> encodedByCpu = execute(recorder, written.same);
  for (size_t q = 0; q < queries.size(); ++q) {
    const uint32_t flags = got.results[q].flags;
    CAPTURE(q, flags, encodedByCpu[q].flags);
    tally.stricter += flags == Flag::range && encodedByCpu[q].flags != Flag::range;
    if (flags != 0 && flags != Flag::range) CHECK((isCoarse || encodedByCpu[q].flags != 0));
  }
}

/// Two scenes of each family of hard cases, with the sensors' numbers rounded to floats.
Tally compareFamilies() {
  Scene scene;
  Recorder recorder(test::device(), scene, kRoom);
  Tally tally;
  for (const tools::HardFamily& family : tools::hardFamilies()) {
    if (family.ignoresLeaving || family.skipsOverlapping) continue;
    for (uint32_t round = 0; round < 2; ++round) {
      CAPTURE(family.name, round);
      const bool isMixed = round % 2 == 0;
      const tools::Workload workload =
          tools::hardScene(family, 71 + round, 0, isMixed ? kRoom.queries : tools::kIsolatedCases,
                           isMixed ? tools::Company::mixed : tools::Company::isolated);
      tools::replaceBy(workload, 0, scene);
      std::vector<HostQuery> queries;
      for (Query& query : test::queriesOf(workload)) {
        query.anyHit = queries.size() % 5 == 4;
        queries.push_back(hostQueryOf(query));
      }
      compare(scene, recorder, queries, family.name == "far baked" && !test::device().doubles(), tally);
    }
  }
  return tally;
}

}  // namespace

TEST_CASE("queries that a host's shader writes are answered with a sweeper's bits, in every family of hard cases",
          "[subgroups]") {
  const Tally tally = compareFamilies();
  CHECK(tally.answered > 1000);
  CHECK(tally.hits > 300);
  CHECK(tally.stricter == 0);
  CHECK(tally.lacking() < tally.answered / 50);
  CHECK(tally.reordered == 0);
}

TEST_CASE("queries that a host's shader writes have the CPU's bits at every scale, far away and in nearly flat poses") {
  const double most = GENERATE(1.0, 8.0, 24.0);
  CAPTURE(most);
  Scene scene;
  Recorder recorder(test::device(), scene, kRoom);
  Tally tally;
  for (uint64_t seed = 0; seed < 120; ++seed) {
    CAPTURE(seed);
    wild::Random random(seed + 1000);
    wild::Made made;
    wild::make(random, most, made);
    scene = std::move(made.scene);
    std::vector<HostQuery> queries;
    for (size_t q = 0; q < made.queries.size(); ++q) {
      made.queries[q].anyHit = q % 4 == 3;
      made.queries[q].distance = std::min(made.queries[q].distance, 3e38);
      double largest = 0;
      for (const double x : made.queries[q].direction) largest = std::max(largest, std::abs(x));
      if (largest < 1e-38 || largest > 1e38) {
        for (double& x : made.queries[q].direction) x /= largest;
      }
      const HostQuery written = hostQueryOf(made.queries[q]);
      if (validate(queryOf(written), scene).empty()) queries.push_back(written);
    }
    compare(scene, recorder, queries, !test::device().doubles(), tally);
  }
  CHECK(tally.answered > (most > 20 ? 300 : 700));
  // Sizes that are just within a limit, and matrices of subnormal numbers.
  CHECK(tally.stricter < tally.answered / (most > 20 ? 20 : 150));
  CHECK(tally.lacking() < tally.answered / 50);
  CHECK(tally.reordered == 0);
}

TEST_CASE("an invalid query gets Flag::query, and those beside it are answered", "[subgroups]") {
  Row row(12);
  const MeshId removed = test::addMesh(row.scene, test::triangle());
  test::addMesh(row.scene, test::triangle());
  Recorder recorder(test::device(), row.scene);
  execute(recorder, row.queries);
  row.scene.removeMesh(removed);
  const HostQuery good = hostQueryOf(row.queries[0]);
  std::vector<HostQuery> bad(16, good);
  bad[0].worldFromMesh[3] = INFINITY;
  bad[1].worldFromMesh[8] = NAN;
  bad[2].direction[1] = NAN;
  bad[3].direction[0] = -INFINITY;
  bad[4].direction[0] = bad[4].direction[1] = bad[4].direction[2] = -0.0f;
  bad[5].distance = NAN;
  bad[6].distance = INFINITY;
  bad[7].distance = -1e-45f;
  bad[8].mesh = removed;
  bad[9].mesh = removed + 2;
  bad[10].mesh = kNone;
  bad[11].flags = 2;
  bad[12].flags = 0x80000001u;
  bad[13].distance = -1;
  bad[14].direction[2] = INFINITY;
  bad[15].mesh = 0x10000000u;  // its record would be far beyond the buffer
  std::vector<Query> queries;
  std::vector<HostQuery> mixed;
  for (size_t i = 0; i < bad.size(); ++i) {
    mixed.push_back(hostQueryOf(row.queries[i % row.queries.size()]));
    queries.push_back(queryOf(mixed.back()));
    mixed.push_back(bad[i]);
  }
  std::vector<Result> expected = test::expectedOf(row.scene, queries);
  Result refused;
  refused.tier = Tier::contact;
  refused.flags = Flag::query;
  for (size_t i = 0; i < bad.size(); ++i) expected.insert(expected.begin() + 2 * ptrdiff_t(i) + 1, refused);
  test::checkSame(execute(recorder, Written(mixed)), expected);
}

TEST_CASE("a written query may exclude an object, select by its mask, and lie at any offset and stride") {
  Row row(12);
  std::vector<HostQuery> written = test::hostQueriesOf(row.queries);
  std::vector<Query> queries;
  for (uint32_t i = 0; i < 12; ++i) {
    written[i].exclude = i % 3 == 0 ? kNone : i % 3 == 1 ? i / 3 : 1000;
    written[i].mask = i % 2 == 0 ? ~0u : 2u;
    queries.push_back(queryOf(written[i]));
    std::erase(queries[i].exclude, 1000u);
  }
  for (ObjectId id = 0; id < 8; ++id) {
    Object object = row.scene.object(id);
    object.mask = id + 1;
    row.scene.removeObject(id);
    REQUIRE(row.scene.addObject(object) == id);
  }
  Recorder recorder(test::device(), row.scene);
  const std::vector<Result> expected = test::expectedOf(row.scene, queries);
  for (const size_t first : {0u, 3u, 20u}) {
    for (const size_t stride : {80u, 81u, 128u}) {
      CAPTURE(first, stride);
      const OnDevice buffer(test::bytesOf(written, first, stride));
      const HostQueries there{.buffer = buffer.get(), .first = first, .stride = stride, .count = 12};
      test::checkSame(execute(recorder, there), expected);
    }
  }
}

TEST_CASE("as many written queries count as the host's number says, and at most as many as it announced") {
  const Row row(12);
  const Written written(row.queries);
  Recorder recorder(test::device(), row.scene);
  const std::vector<Result> expected = test::expectedOf(row.scene, written.same);
  HostQueries counted = written;
  counted.countOffset = 3;
  for (const uint32_t number : {0u, 1u, 7u, 12u, 13u, ~0u}) {
    CAPTURE(number);
    std::vector<std::byte> bytes(counted.countOffset);
    test::append<uint32_t>(bytes, {number});
    const OnDevice counts(bytes);
    counted.countBuffer = counts.get();
    const size_t most = std::min(number, 12u);
    test::checkSame(execute(recorder, counted), std::span(expected).first(most));
    // On the device, answers beyond that number say that there was no query.
    const std::vector<Result> all = test::elementsOf<Result>(recorder.results(), 0, 12);
    for (size_t i = most; i < 12; ++i) CHECK(test::isRefused(all[i], Flag::query));
  }
  CHECK(execute(recorder, Written(std::vector<HostQuery>())).empty());
  CHECK(execute(recorder, HostQueries{.buffer = written.buffer.get(), .stride = 128}).empty());
}

TEST_CASE("a direction whose length lies between two doubles is left to read()") {
  // |(1, 2^-26, 0)| is 1 + 2^-53 - 2^-107.
  Row row(4);
  row.queries[3].direction = {0, 0x1p-26, 1};
  const Written written(std::span(row.queries).last(1));
  Recorder recorder(test::device(), row.scene);
  const std::vector<Result> expected = test::expectedOf(row.scene, written.same);
  CHECK(expected[0].status == Status::hit);
  test::checkSame(execute(recorder, written), expected);
  CHECK(test::elementsOf<Result>(recorder.results(), 0, 1)[0].flags == Flag::unresolved);
}

TEST_CASE("among no objects, and beyond the range of floats, written queries are answered as others are") {
  Scene scene;
  const Written written({HostQuery{.direction = {0, 0, 1}, .distance = 1, .mesh = test::addBox(scene)}});
  Recorder recorder(test::device(), scene);
  test::checkSame(execute(recorder, written), execute(recorder, written.same));
  CHECK(execute(recorder, written)[0].status == Status::clear);
  scene.addObject({.mesh = 0, .worldFromMesh = test::at(0, 0, 0x1p90)});
  test::checkSame(execute(recorder, written), execute(recorder, written.same));
  CHECK(execute(recorder, written)[0].flags == Flag::range);
}

TEST_CASE("a written query whose matrix is singular is answered for the flattened mesh") {
  // As floats that are exact: the answers must not depend on who flattens.
  const tools::MeshData hook = tools::makeHook(3, 1, 0.5, 0.25);
  tools::MeshData flat = hook;
  for (size_t k = 2; k < flat.positions.size(); k += 3) flat.positions[k] = 0;
  Row row(1);
  const MeshId mesh = test::addMesh(row.scene, hook), flattened = test::addMesh(row.scene, flat);
  Recorder recorder(test::device(), row.scene, kRoom);
  std::vector<HostQuery> written;
  std::vector<Query> queries;
  for (uint32_t i = 0; i < 24; ++i) {
    HostQuery query{
        .worldFromMesh = {0, 0.25f, 0, 0.3f * static_cast<float>(i), 0.25f, 0.125f, 0, 0.1f, 0.5f, 0, 0, -3},
        .direction = {0.01f * static_cast<float>(i % 5), 0, 1},
        .distance = 20,
        .mesh = mesh,
        .flags = i % 4 == 3 ? HostQuery::kAnyHit : 0};
    written.push_back(query);
    query.mesh = flattened;
    query.worldFromMesh[2] = 1;  // along which the flat mesh has no extent
    queries.push_back(queryOf(query));
  }
  const std::vector<Result> expected = test::expectedOf(row.scene, queries);
  test::checkSame(execute(recorder, Written(written)), expected);
  CHECK(std::ranges::count(expected, Status::hit, &Result::status) > 10);
}
