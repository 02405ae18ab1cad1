// Whichever side answers a batch, the answers are the same; and what decides it.
#include "radar/pool.h"
#include "support/catch.h"
#include "support/pretended_gpu.h"
#include "support/same_bits.h"
#include "support/test_device.h"
#include "support/world.h"
#include "sweep/sweeper.h"
#include "workloads/generate.h"
#include "workloads/random.h"

namespace {

using namespace radar;
using test::differenceOf;

constexpr std::array kKinds{BatchKind::plain, BatchKind::clearance, BatchKind::each};
constexpr size_t kSize = 40;

Device pretendedGpu() {
  return Device::adopt(test::asGpu(test::device().handles()));
}

test::Case boxes() {
  return test::caseOf(
      tools::makeWorkload(tools::Table1{.boxes = 1'000, .sensors = kSize, .shape = tools::SensorShape::box}));
}

std::vector<Query> ofKind(BatchKind kind, std::vector<Query> queries) {
  for (Query& query : queries) {
    if (kind == BatchKind::clearance) query.clearance = 0.125;
    if (kind == BatchKind::each) query.hits = 3;
  }
  return queries;
}

Sweeper onCpu(const Scene& scene) {
  return {test::device(), scene};
}

/// Who expects that the other side takes forever.
std::shared_ptr<BatchRouter> onlyOn(Side side) {
  BatchTimes times(2);
  for (const BatchKind kind : kKinds) {
    for (int i = 0; i < 20; ++i) times.took(side == Side::cpu ? Side::device : Side::cpu, kind, kSize, 1e6);
  }
  return std::make_shared<BatchRouter>(times);
}

Answers answersOf(Sweeper::Impl& sweeper, std::span<const Query> queries) {
  Flight flight(queries, false);
  sweeper.begin(flight, Mode::contact);
  sweeper.finish(flight);
  REQUIRE_FALSE(flight.failure);
  return std::move(flight.answers);
}

Sweeper::Impl sweeperOn(const Device& device, const Scene& scene, const SweeperOptions& options = {}) {
  return {device.impl(), scene, options, std::make_shared<GpuScene>(device.impl())};
}

}  // namespace

TEST_CASE("the side from which less is expected answers batches of each kind, with the same bits, and is counted") {
  const test::Case asked = boxes();
  const Device device = pretendedGpu();
  for (const Side side : {Side::cpu, Side::device}) {
    Sweeper::Impl sweeper = sweeperOn(device, asked.scene);
    sweeper.router = onlyOn(side);
    for (const BatchKind kind : kKinds) {
      CAPTURE(static_cast<int>(side), static_cast<int>(kind));
      const std::vector<Query> queries = ofKind(kind, asked.queries);
      for (int i = 0; i < 3; ++i) {
        const Answers found = answersOf(sweeper, queries);
        CHECK(differenceOf(found, onCpu(asked.scene).run(queries)) == "");
        CHECK((found.stats.submissions > 0) == (side == Side::device));
        if (side == Side::cpu) CHECK(found.stats.cpuQueries == kSize);
        // A clearance may be left to the CPU; so may any query without doubles.
        if (side == Side::device && kind != BatchKind::clearance && device.doubles())
          CHECK(found.stats.cpuQueries == 0);
      }
    }
  }
}

TEST_CASE("a sweeper on a GPU learns, and the next one on the same device begins with that") {
  const test::Case asked = boxes();
  const Device device = pretendedGpu();
  const auto expected = [](const Sweeper::Impl& sweeper, BatchKind kind) {
    return sweeper.router->times().expected(Side::cpu, kind, kSize);
  };
  std::array<double, 3> learnt{};
  {
    const Sweeper::Impl idle = sweeperOn(device, asked.scene);  // ends later, but has learnt nothing
    Sweeper::Impl sweeper = sweeperOn(device, asked.scene);
    for (const BatchKind kind : kKinds) {
      const double before = expected(sweeper, kind);
      answersOf(sweeper, ofKind(kind, asked.queries));  // on the CPU: so few are expected to be too few
      CHECK(expected(sweeper, kind) != before);
    }
    for (const BatchKind kind : kKinds) learnt[static_cast<size_t>(kind)] = expected(sweeper, kind);
  }
  const Sweeper::Impl next = sweeperOn(device, asked.scene);
  for (const BatchKind kind : kKinds) CHECK(expected(next, kind) == learnt[static_cast<size_t>(kind)]);
}

TEST_CASE("nothing is learnt where the options decide, on a device that is a CPU, and from a batch that is given up") {
  const test::Case asked = boxes();
  const Device device = pretendedGpu();
  CHECK(sweeperOn(device, asked.scene, {.cpuBatch = 16}).router == nullptr);
  CHECK(sweeperOn(test::device(), asked.scene).router == nullptr);
  Sweeper::Impl sweeper = sweeperOn(device, asked.scene);
  for (const Side side : {Side::cpu, Side::device}) {
    sweeper.router = onlyOn(side);
    const double before = sweeper.router->times().expected(side, BatchKind::plain, kSize);
    std::stop_source stop;
    stop.request_stop();
    Flight flight(asked.queries, false, stop.get_token());
    sweeper.begin(flight, Mode::contact);
    sweeper.finish(flight);
    CHECK(flight.answers.reasons.size() == kSize);
    CHECK(sweeper.router->times().expected(side, BatchKind::plain, kSize) == before);
  }
}

TEST_CASE("a sweeper and a pool on a GPU give the CPU's bits to batches of any size and kind") {
  const test::Case asked = boxes();
  const Device device = pretendedGpu();
  Sweeper sweeper(device, asked.scene);
  Sweeper cpu = onCpu(asked.scene);
  tools::Random random(23);
  std::vector<std::vector<Query>> batches;
  for (int i = 0; i < 40; ++i) {
    batches.push_back(ofKind(kKinds[random.below(3)], asked.queries));
    batches.back().resize(1 + random.below(kSize));
  }
  for (const std::vector<Query>& batch : batches) CHECK(differenceOf(sweeper.run(batch), cpu.run(batch)) == "");
  Pool pool({&device, 1}, asked.scene);
  std::vector<std::future<PoolAnswers>> futures;
  for (const std::vector<Query>& batch : batches) futures.push_back(pool.submit(batch));
  for (size_t i = 0; i < batches.size(); ++i) {
    CHECK(differenceOf(futures[i].get().results, cpu.run(batches[i]).results) == "");
  }
}
