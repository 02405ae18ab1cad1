// The choice between device and CPU, learnt on machines that only tell how long they would take.
#include "sweep/batch_router.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "support/catch.h"
#include "workloads/random.h"

namespace {

using namespace radar;
using tools::Random;

struct Machine {
  const char* name;
  double deviceFixed, deviceEach;
  double cpuEach;  ///< on one thread
  unsigned threads;
  double noise = 0;  ///< a batch takes up to 2^noise times as long, or that part of it

  /// Seconds of a batch.
  double takes(Side side, size_t queries) const {
    const auto n = static_cast<double>(queries);
    if (side == Side::device) return deviceFixed + deviceEach * n;
    return std::min(cpuEach * n, 60e-6 + cpuEach * n / threads);
  }
  Side faster(size_t queries) const {
    return takes(Side::device, queries) < takes(Side::cpu, queries) ? Side::device : Side::cpu;
  }
  /// How many times as long the slower side takes.
  double differ(size_t queries) const {
    const double ratio = takes(Side::device, queries) / takes(Side::cpu, queries);
    return std::max(ratio, 1 / ratio);
  }
};

const Machine kExpected{"as is expected", 1.1e-3, 0.37e-6, 10e-6, 16};
const std::vector<Machine> kMachines{kExpected,
                                     {"a device that is fed", 0.1e-3, 0.06e-6, 10e-6, 16},
                                     {"a device beside one thread", 0.3e-3, 0.37e-6, 5e-6, 1},
                                     {"a device that is slower with all batches", 20e-3, 10e-6, 10e-6, 16},
                                     {"a very slow device", 0.5, 1e-3, 5e-6, 2},
                                     {"a device that is faster with all batches", 1e-6, 0.01e-6, 10e-6, 4},
                                     {"cheap queries", 0.3e-3, 0.1e-6, 0.5e-6, 16},
                                     {"dear queries", 2e-3, 1.5e-6, 190e-6, 16},
                                     {"times that vary", 0.2e-3, 0.1e-6, 10e-6, 8, 1}};

/// Batches on a machine, one after the other.
struct Course {
  Machine machine;
  BatchRouter router{BatchTimes(machine.threads)};
  Random random{7};
  double all = 0;                   ///< seconds
  double byTries = 0, byTrust = 0;  ///< seconds that were lost by tries, and on the side from which less was expected
  double beyond = 0;                ///< the most that a try lost beyond its price
  double longest = 0;

  BatchRouter::Choice run(size_t queries, BatchKind kind = BatchKind::plain) {
    const BatchRouter::Choice choice = router.choose(kind, queries);
    const double noise = std::exp2(machine.noise * random.uniform(-1, 1));
    const double seconds = noise * machine.takes(choice.side, queries);
    router.took(choice, seconds);
    const double lost = seconds - noise * machine.takes(machine.faster(queries), queries);
    all += seconds;
    longest = std::max(longest, seconds);
    (choice.price > 0 ? byTries : byTrust) += lost;
    if (choice.price > 0) beyond = std::max(beyond, lost - choice.price);
    return choice;
  }
  double ratio(size_t queries, BatchKind kind = BatchKind::plain) const {
    return router.times().expected(Side::device, kind, queries) / router.times().expected(Side::cpu, kind, queries);
  }
  /// The side from which less is expected.
  Side trusted(size_t queries, BatchKind kind = BatchKind::plain) const {
    return ratio(queries, kind) < 1 ? Side::device : Side::cpu;
  }
};

constexpr double kMatters = 1.5;  // sides that differ by less need not be told apart

}  // namespace

TEST_CASE("after 500 batches of random sizes the router knows of every size which side is faster") {
  for (const Machine& machine : kMachines) {
    CAPTURE(machine.name);
    Course course{machine};
    Random random(3);
    for (int i = 0; i < 500; ++i) course.run(static_cast<size_t>(std::exp2(random.uniform(0, 17))));
    for (size_t size = 1; size <= size_t{1} << 17; size += 1 + size / 3) {
      CAPTURE(size, machine.differ(size));
      if (machine.differ(size) > kMatters) CHECK(course.trusted(size) == machine.faster(size));
    }
    // What a machine costs that is unlike what is expected: two or three batches. Near the crossover, noise decides.
    CHECK(course.byTrust <= 0.03 * course.all + 3 * course.longest);
  }
}

TEST_CASE("tries never lose more than a 32nd of the whole time and what one of them lost beyond its price") {
  for (const Machine& machine : kMachines) {
    Course course{machine};
    Random random(5);
    const size_t fixed = GENERATE(size_t{0}, size_t{1}, size_t{300}, size_t{5'000}, size_t{200'000});
    for (int i = 0; i < 3'000; ++i) {
      const size_t size = fixed > 0 ? fixed : static_cast<size_t>(std::exp2(random.uniform(0, 17)));
      course.run(size);
      if (course.byTries <= BatchRouter::kTriesShare * course.all * (1 + machine.noise) + course.beyond) continue;
      CAPTURE(machine.name, fixed, i, course.byTries, course.all, course.beyond);
      FAIL("tries lost more");
    }
  }
}

TEST_CASE("of batches of one size, the faster side is found after as many as the contract says") {
  for (const Machine& machine : kMachines) {
    for (uint32_t power = 0; power <= 18; ++power) {
      const size_t size = size_t{1} << power;
      Course course{machine};
      for (int i = 0; i < 10; ++i) course.run(size);  // of the trusted side it then knows
      const double ratio = std::max(course.ratio(size), 1 / course.ratio(size));
      const bool isTried = ratio <= BatchRouter::kMostTimes || size < 1'000;
      if (!isTried || machine.differ(size) < kMatters) continue;
      // Two tries: the first on the device is no measure if it has to make room.
      const double batches = 20 + 2 * 32 * (ratio - 1) * (1 + BatchTimes::kUnknown);
      for (double i = 0; i < batches; ++i) course.run(size);
      CAPTURE(machine.name, size, ratio, batches, machine.differ(size));
      CHECK(course.trusted(size) == machine.faster(size));
    }
  }
}

TEST_CASE("no try is expected to take both eight times as long as the other side and ten milliseconds longer") {
  for (const Machine& machine : kMachines) {
    Course course{machine};
    Random random(11);
    int tries = 0;
    for (int i = 0; i < 3'000; ++i) {
      const auto size = static_cast<size_t>(std::exp2(random.uniform(0, 17)));
      const BatchTimes before = course.router.times();
      const BatchRouter::Choice choice = course.run(size);
      if (choice.price == 0) continue;
      ++tries;
      const double taken = before.expected(choice.side, choice.kind, size);
      CHECK((taken <= 8 * choice.otherwise || taken <= choice.otherwise + 10e-3));
      CHECK(taken > choice.otherwise);
    }
    CHECK(tries > 0);
  }
}

TEST_CASE("a side that becomes slower or faster is noticed, and each kind of batch is learnt by itself") {
  const Machine fast{"", 0.1e-3, 0.06e-6, 10e-6, 16}, slow{"", 4e-3, 1.5e-6, 10e-6, 16};
  constexpr size_t kSize = 4'096;
  Course course{fast};
  for (int i = 0; i < 10; ++i) course.run(kSize);
  CHECK(course.trusted(kSize) == Side::device);
  // What is chosen is measured.
  course.machine = slow;
  for (int i = 0; i < 20; ++i) course.run(kSize);
  CHECK(course.trusted(kSize) == Side::cpu);
  // What is not chosen has to be tried.
  course.machine = fast;
  for (int i = 0; i < 500; ++i) course.run(kSize);
  CHECK(course.trusted(kSize) == Side::device);
  CHECK(course.ratio(kSize, BatchKind::each) == Course{fast}.ratio(kSize, BatchKind::each));
  course.machine = slow;
  for (int i = 0; i < 20; ++i) course.run(kSize, BatchKind::each);
  CHECK(course.trusted(kSize, BatchKind::each) == Side::cpu);
  CHECK(course.trusted(kSize) == Side::device);
}

TEST_CASE("sides from which nearly the same is expected are both measured, whatever tries may lose") {
  constexpr size_t kSize = 4'096;
  BatchTimes times(16);
  const double same = times.expected(Side::device, BatchKind::plain, kSize);
  times.took(Side::device, BatchKind::plain, kSize, same);
  times.took(Side::cpu, BatchKind::plain, kSize, 1.001 * same);
  BatchRouter router(times);
  for (int i = 0; i < 50; ++i) {  // which earns as much as some tries at kSize cost
    const BatchRouter::Choice choice = router.choose(BatchKind::each, 100'000);
    router.took(choice, router.times().expected(choice.side, choice.kind, choice.queries));
  }
  std::array<int, 2> chosen{};
  for (int i = 0; i < 30; ++i) {
    const BatchRouter::Choice choice = router.choose(BatchKind::plain, kSize);
    ++chosen[static_cast<size_t>(choice.side)];
    router.took(choice, (choice.side == Side::cpu ? 1.001 : 1) * same);
  }
  CHECK(chosen == std::array{10, 20});
}

TEST_CASE("one batch that a machine stalls in does not change the side that answers") {
  constexpr size_t kSize = 16'384;
  Course course{{"", 0.1e-3, 0.06e-6, 10e-6, 16}};
  for (int i = 0; i < 10; ++i) course.run(kSize);
  BatchRouter& router = course.router;
  BatchRouter::Choice choice = router.choose(BatchKind::plain, kSize);
  while (choice.price > 0) choice = router.choose(BatchKind::plain, kSize);
  REQUIRE(choice.side == Side::device);
  router.took(choice, 10.0);
  CHECK(course.trusted(kSize) == Side::device);
}

TEST_CASE("the first batch of its size on the device is no measure of it unless it is fast: it makes room") {
  constexpr size_t kSize = 16'384;
  BatchRouter router{BatchTimes(1)};
  const auto expected = [&] { return router.times().expected(Side::device, BatchKind::plain, kSize); };
  const double before = expected();
  BatchRouter::Choice choice = router.choose(BatchKind::plain, kSize);
  REQUIRE(choice.side == Side::device);
  router.took(choice, 4 * before);
  CHECK(expected() == before);
  router.took(choice, 4 * before);
  CHECK(expected() == Approx(4 * before));
  BatchRouter other{BatchTimes(1)};
  choice = other.choose(BatchKind::plain, kSize);
  other.took(choice, before / 4);
  CHECK(other.times().expected(Side::device, BatchKind::plain, kSize) == Approx(before / 4));
}

TEST_CASE("what is known of one size tells of its neighbours, and what one router knows another begins with") {
  BatchTimes times(4);
  CHECK(times.distance(Side::cpu, BatchKind::plain, 1000) == BatchTimes::kUnknown);
  const double before = times.expected(Side::cpu, BatchKind::plain, 1 << 20);
  times.took(Side::cpu, BatchKind::plain, 1'000, 2 * times.expected(Side::cpu, BatchKind::plain, 1'000));
  CHECK(times.distance(Side::cpu, BatchKind::plain, 1'024) == 0);
  CHECK(times.distance(Side::cpu, BatchKind::plain, 2'000) == 1);
  CHECK(times.distance(Side::cpu, BatchKind::plain, 1) == BatchTimes::kUnknown);
  CHECK(times.expected(Side::cpu, BatchKind::plain, 1 << 20) == Approx(2 * before));
  CHECK(times.expected(Side::cpu, BatchKind::clearance, 1 << 20) == before);
  // With other threads, the queries are as dear as they were.
  const double many = BatchTimes(16).expected(Side::cpu, BatchKind::plain, 5'000);
  CHECK(times.with(16).expected(Side::cpu, BatchKind::plain, 5'000) == Approx(2 * many));
  for (uint32_t power = 0; power < 32; ++power) {
    CHECK(BatchTimes::powerOf(size_t{1} << power) == power);
    CHECK(BatchTimes::powerOf((size_t{3} << power) / 2) == power + (power > 0 ? 1 : 0));
    CHECK(BatchTimes::powerOf((size_t{5} << power) / 4) == power);
  }
}
