// The families asked again with D where the contact is, and a rounding beside it; and only whether there is one.
#include <catch2/catch.hpp>
#include <cmath>

#include "stability/method.h"
#include "stability/promises.h"
#include "support/answer.h"
#include "support/test_device.h"
#include "workloads/stability.h"

using namespace radar;
using namespace radar::tools;

namespace {

constexpr uint32_t kResolution = 32;

/// One family after the other, its queries with D moved to the exact t, one rounding less and one more.
struct AtContact {
  AtContact() : sweeper(test::device(), scene, {.cpuBatch = 0}), cpu(scene) {}

  void show(const StabilityFamily& family) {
    std::vector<StabilityCase> cases;
    for (uint64_t i = 0; i < kCasesPerScene; ++i) cases.push_back(stabilityCase(family, i, 17));
    const Workload workload = workloadOf(cases);
    replaceBy(workload, 0, scene);
    queries.clear();
    for (const QuerySpec& spec : workload.queries) {
      Query query = toQuery(spec, Mode::contact);
      const Result first = test::answer(cpu, query);
      if (first.status != Status::hit) continue;
      for (const double distance : {std::nextafter(first.t, 0), first.t, std::nextafter(first.t, INFINITY)}) {
        query.distance = distance;
        queries.push_back(query);
      }
    }
    exact = cpu.run(queries);
  }

  Scene scene;
  Sweeper sweeper;
  CpuSweeper cpu;
  std::vector<Query> queries;
  std::vector<Result> exact;
};

}  // namespace

TEST_CASE("where methods fail, D at the contact and a rounding beside it keeps every promise") {
  AtContact asking;
  for (const StabilityFamily& family : stabilityFamilies()) {
    asking.show(family);
    REQUIRE(asking.queries.size() >= 3);
    const std::vector<Result> contact = answersBy(Method::contact, asking.sweeper, asking.queries, 0);
    const std::vector<Result> sampled = answersBy(Method::sampled, asking.sweeper, asking.queries, kResolution);
    for (size_t i = 0; i < asking.queries.size(); ++i) {
      CAPTURE(family.name, i, asking.exact[i].t, asking.queries[i].distance);
      const Query& query = asking.queries[i];
      CHECK(judgeContact(asking.scene, query, contact[i], asking.exact[i]).words() == "");
      CHECK(judgeSampled(query, sampled[i], asking.exact[i]).words() == "");
    }
  }
}

TEST_CASE("where methods fail, whether there is a contact within D is decided rightly") {
  AtContact asking;
  for (const StabilityFamily& family : stabilityFamilies()) {
    asking.show(family);
    for (Query& query : asking.queries) query.anyHit = true;
    const std::vector<Result> contact = answersBy(Method::contact, asking.sweeper, asking.queries, 0);
    const std::vector<Result> sampled = answersBy(Method::sampled, asking.sweeper, asking.queries, kResolution);
    for (size_t i = 0; i < asking.queries.size(); ++i) {
      CAPTURE(family.name, i, asking.exact[i].t, asking.queries[i].distance);
      const bool meets = asking.exact[i].status != Status::clear;
      CHECK(contact[i].status == (meets ? Status::hit : Status::clear));
      CHECK(sampled[i].status != (meets ? Status::clear : Status::hit));
    }
  }
}
