// Queries that a host's shaders write: their answers have the bits of a sweeper's for the same numbers.
#include <cmath>
#include <limits>
#include <random>

#include "embed/renderer.h"
#include "embed/written_queries.h"

#include "radar/cpu_sweeper.h"
#include "support/buffer_words.h"
#include "support/catch.h"
#include "unit/cpu_wild_scenes.h"
#include "workloads/shapes.h"

namespace {

using namespace radar;
using test::execute;
using test::hostQueryOf;
using test::kRoom;
using test::OnDevice;
using test::queryOf;
using test::Row;
using test::sameBits;

/// The CPU's answers, as of the tier that a Recorder names.
std::vector<Result> expectedOf(const Scene& scene, std::span<const Query> queries) {
  std::vector<Result> expected = CpuSweeper(scene, 1).run(queries).results;
  for (Result& result : expected) result.tier = Tier::contact;
  return expected;
}

struct Tally {
  size_t hits = 0, answered = 0, outOfRange = 0, lacking = 0;
  size_t stricter = 0;  ///< out of range only for the shader
};

/// Compares the answers with the CPU's. A query that lacks room must do so when the CPU encodes it, too, unless
/// `isCoarse`: without doubles, a mesh far from its own origin is placed coarsely.
void compare(const Scene& scene, Recorder& recorder, std::span<const HostQuery> written, bool isCoarse, Tally& tally) {
  std::vector<Query> queries;
  for (const HostQuery& query : written) queries.push_back(queryOf(query));
  const std::vector<Result> got = execute(recorder, written), encodedByCpu = execute(recorder, queries),
                            expected = expectedOf(scene, queries);
  REQUIRE(got.size() == written.size());
  for (size_t q = 0; q < written.size(); ++q) {
    CAPTURE(q, got[q].flags, encodedByCpu[q].flags, got[q].t, expected[q].t, got[q].lo, expected[q].lo);
    if (got[q].flags == 0) {
      CHECK(sameBits(got[q], expected[q]));
      ++tally.answered;
      tally.hits += got[q].status == Status::hit;
    } else if (got[q].flags == Flag::range) {
      CHECK(got[q].status == Status::invalid);
      ++tally.outOfRange;
      tally.stricter += encodedByCpu[q].flags != Flag::range;
    } else {
      CHECK((got[q].flags & (Flag::candidates | Flag::rounds | Flag::unresolved)) != 0);
      CHECK((isCoarse || encodedByCpu[q].flags != 0));
      ++tally.lacking;
    }
  }
}

/// `rounds` scenes of each family of hard cases, with the sensors' numbers rounded to floats.
Tally compareFamilies(uint32_t rounds) {
  Scene scene;
  Recorder recorder(test::device(), scene, kRoom);
  Tally tally;
  for (const tools::HardFamily& family : tools::hardFamilies()) {
    if (family.ignoresLeaving || family.skipsOverlapping) continue;
    for (uint32_t round = 0; round < rounds; ++round) {
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
  const Tally tally = compareFamilies(2);
  CHECK(tally.answered > 1000);
  CHECK(tally.hits > 300);
  CHECK(tally.stricter == 0);
  CHECK(tally.lacking < tally.answered / 50);
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("queries that a host's shader writes are answered with a sweeper's bits, in many scenes", "[.][many]") {
  CHECK(compareFamilies(60).answered > 30'000);
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
  CHECK(tally.stricter < tally.answered / (most > 20 ? 20 : 200));
  CHECK(tally.lacking < tally.answered / 50);
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("an invalid query gets Flag::query, and those beside it are answered", "[subgroups]") {
  Row row(12);
  const MeshId removed =
      row.scene.addMesh(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, std::vector<uint32_t>{0, 1, 2});
  row.scene.addMesh(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, std::vector<uint32_t>{0, 1, 2});
  Recorder recorder(test::device(), row.scene);
  execute(recorder, row.queries);
  row.scene.removeMesh(removed);
  const float infinite = std::numeric_limits<float>::infinity(), none = std::numeric_limits<float>::quiet_NaN();
  const HostQuery good = hostQueryOf(row.queries[0]);
  std::vector<HostQuery> bad(16, good);
  bad[0].worldFromMesh[3] = infinite;
  bad[1].worldFromMesh[8] = none;
  bad[2].direction[1] = none;
  bad[3].direction[0] = -infinite;
  bad[4].direction[0] = bad[4].direction[1] = bad[4].direction[2] = -0.0f;
  bad[5].distance = none;
  bad[6].distance = infinite;
  bad[7].distance = -1e-45f;
  bad[8].mesh = removed;
  bad[9].mesh = removed + 2;
  bad[10].mesh = kNone;
  bad[11].flags = 2;
  bad[12].flags = 0x80000001u;
  bad[13].distance = -1;
  bad[14].direction[2] = infinite;
  bad[15].mesh = 0x10000000u;  // its record would be far beyond the buffer
  std::vector<HostQuery> written;
  std::vector<Query> queries;
  for (size_t i = 0; i < bad.size(); ++i) {
    queries.push_back(queryOf(hostQueryOf(row.queries[i % row.queries.size()])));
    written.push_back(hostQueryOf(queries.back()));
    written.push_back(bad[i]);
  }
  const std::vector<Result> read = execute(recorder, written), expected = expectedOf(row.scene, queries);
  REQUIRE(read.size() == written.size());
  for (size_t i = 0; i < bad.size(); ++i) {
    CAPTURE(i);
    CHECK(sameBits(read[2 * i], expected[i]));
    Result refused;
    refused.tier = Tier::contact;
    refused.flags = Flag::query;
    CHECK(sameBits(read[2 * i + 1], refused));
  }
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("a written query may exclude an object, select by its mask, and lie at any offset and stride") {
  Row row(12);
  std::vector<HostQuery> written;
  std::vector<Query> queries;
  for (uint32_t i = 0; i < 12; ++i) {
    written.push_back(hostQueryOf(row.queries[i]));
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
  const std::vector<Result> expected = expectedOf(row.scene, queries);
  for (const size_t first : {0u, 3u, 20u}) {
    for (const size_t stride : {80u, 81u, 128u}) {
      CAPTURE(first, stride);
      const OnDevice buffer(test::bytesOf(written, first, stride));
      const std::vector<Result> read =
          execute(recorder, HostQueries{.buffer = buffer.get(), .first = first, .stride = stride, .count = 12});
      REQUIRE(read.size() == 12);
      for (size_t i = 0; i < 12; ++i) {
        CAPTURE(i);
        CHECK(sameBits(read[i], expected[i]));
      }
    }
  }
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("as many written queries count as the host's number says, and at most as many as it announced") {
  Row row(12);
  std::vector<HostQuery> written;
  for (const Query& query : row.queries) written.push_back(hostQueryOf(query));
  std::vector<Query> queries;
  queries.reserve(written.size());
  for (const HostQuery& query : written) queries.push_back(queryOf(query));
  Recorder recorder(test::device(), row.scene);
  const std::vector<Result> expected = expectedOf(row.scene, queries);
  const OnDevice buffer(test::bytesOf(written));
  for (const uint32_t number : {0u, 1u, 7u, 12u, 13u, ~0u}) {
    CAPTURE(number);
    std::vector<std::byte> bytes(3);
    test::append<uint32_t>(bytes, {number});
    const OnDevice counts(bytes);
    const std::vector<Result> read = execute(
        recorder, HostQueries{.buffer = buffer.get(), .count = 12, .countBuffer = counts.get(), .countOffset = 3});
    REQUIRE(read.size() == std::min(number, 12u));
    for (size_t i = 0; i < read.size(); ++i) CHECK(sameBits(read[i], expected[i]));
    // On the device, answers beyond that number say that there was no query.
    const std::vector<Result> all = test::elementsOf<Result>(recorder.results(), 0, 12);
    for (size_t i = read.size(); i < 12; ++i) {
      CHECK(all[i].status == Status::invalid);
      CHECK(all[i].flags == Flag::query);
    }
  }
  CHECK(execute(recorder, std::span<const HostQuery>()).empty());
  CHECK(execute(recorder, HostQueries{.buffer = buffer.get(), .stride = 128}).empty());
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("record refuses written queries that do not fit, says why, and records queries afterwards") {
  Row row(3);
  Recorder recorder(test::device(), row.scene, {.queries = 3});
  const OnDevice buffer(std::vector<std::byte>(1024));
  const auto refused = [&](const HostQueries& queries, const char* why) {
    CHECK_THROWS_WITH(execute(recorder, queries), test::Contains(why));
  };
  refused({.count = 1}, "record: queries: expected a buffer");
  refused({.buffer = buffer.get(), .stride = 79, .count = 1}, "queries: stride: expected at least 80 bytes, got 79");
  refused({.buffer = buffer.get(), .count = 4}, "record: queries: count: expected at most 3, got 4");
  refused({.buffer = buffer.get(), .stride = VkDeviceSize{1} << 40, .count = 2}, "maxStorageBufferRange");
  row.scene.setMotion(0, {1, 0, 0});
  refused({.buffer = buffer.get(), .count = 1}, "record: queries: expected a scene in which no object has a motion");
  row.scene.setMotion(0, {});
  std::vector<HostQuery> written;
  for (const Query& query : row.queries) written.push_back(hostQueryOf(query));
  const std::vector<Result> read = execute(recorder, written), after = execute(recorder, row.queries);
  const std::vector<Result> expected = expectedOf(row.scene, row.queries);
  CHECK(read[2].status == Status::hit);
  for (size_t i = 0; i < 3; ++i) CHECK(sameBits(after[i], expected[i]));
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("a direction whose length lies between two doubles is left to read()") {
  // |(1, 2^-26, 0)| is 1 + 2^-53 - 2^-107.
  Row row(4);
  HostQuery query = hostQueryOf(row.queries[3]);
  query.direction[0] = 0;
  query.direction[1] = 0x1p-26f;
  query.direction[2] = 1;
  const Query same = queryOf(query);
  Recorder recorder(test::device(), row.scene);
  const std::vector<Result> read = execute(recorder, {&query, 1});
  const Result expected = expectedOf(row.scene, {&same, 1})[0];
  CHECK(expected.status == Status::hit);
  CHECK(sameBits(read[0], expected));
  CHECK(test::elementsOf<Result>(recorder.results(), 0, 1)[0].flags == Flag::unresolved);
}

TEST_CASE("among no objects, and beyond the range of floats, written queries are answered as others are") {
  Scene scene;
  const tools::MeshData box = tools::makeBox({1, 1, 1});
  HostQuery query{.direction = {0, 0, 1}, .distance = 1, .mesh = scene.addMesh(box.positions, box.indices)};
  const Query same = queryOf(query);
  Recorder recorder(test::device(), scene);
  CHECK(sameBits(execute(recorder, {&query, 1})[0], execute(recorder, {&same, 1})[0]));
  CHECK(execute(recorder, {&query, 1})[0].status == Status::clear);
  scene.addObject({query.mesh, {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0x1p90}}, ~0u});
  CHECK(sameBits(execute(recorder, {&query, 1})[0], execute(recorder, {&same, 1})[0]));
  CHECK(execute(recorder, {&query, 1})[0].flags == Flag::range);
}

TEST_CASE("a written query whose matrix is singular is answered for the flattened mesh") {
  // As floats that are exact: the answers must not depend on who flattens.
  const tools::MeshData hook = tools::makeHook(3, 1, 0.5, 0.25);
  tools::MeshData flat = hook;
  for (size_t k = 2; k < flat.positions.size(); k += 3) flat.positions[k] = 0;
  Row row(1);
  const MeshId mesh = row.scene.addMesh(hook.positions, hook.indices),
               flattened = row.scene.addMesh(flat.positions, flat.indices);
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
  const std::vector<Result> read = execute(recorder, written), expected = expectedOf(row.scene, queries);
  size_t hits = 0;
  for (size_t i = 0; i < read.size(); ++i) {
    CAPTURE(i, read[i].flags, read[i].t, expected[i].t);
    CHECK(sameBits(read[i], expected[i]));
    hits += read[i].status == Status::hit;
  }
  CHECK(hits > 10);
}
