// Compares the CPU's search with itself: on one thread and on several, by a sweeper that has followed the scene and by
// a new one, with and without `anyHit`. Other tests compare it with brute force.
#pragma once

#include "radar/cpu_sweeper.h"
#include "soups.h"
#include "support/same_bits.h"
#include "workloads/workload.h"

namespace agreement {

using radar::test::sameBits;

/// Sweepers of 1, 2 and 5 threads that follow one scene.
class ThreadedSweepers {
 public:
  explicit ThreadedSweepers(const radar::Scene& scene)
      : scene_(scene), one_(scene, 1), two_(scene, 2), five_(scene, 5) {}

  void check(std::vector<radar::Query> queries) {
    const std::vector<radar::Result> exact = radar::CpuSweeper(scene_, 1).run(queries).results;
    compare(queries, exact);
    for (radar::Query& query : queries) query.anyHit = true;
    const std::vector<radar::Result> decided = radar::CpuSweeper(scene_, 1).run(queries).results;
    compare(queries, decided);
    for (size_t i = 0; i < queries.size(); ++i) {
      INFO("query " << i << " of " << queries.size() << ", anyHit");
      const bool meets = exact[i].status != radar::Status::clear;
      REQUIRE(decided[i].status == (meets ? radar::Status::hit : radar::Status::clear));
      if (!meets) continue;
      REQUIRE(decided[i].lo == 0);
      REQUIRE(decided[i].hi == queries[i].distance);
    }
  }

 private:
  void compare(const std::vector<radar::Query>& queries, const std::vector<radar::Result>& expected) {
    for (radar::CpuSweeper* sweeper : {&one_, &two_, &five_}) {
      const std::vector<radar::Result> results = sweeper->run(queries).results;
      REQUIRE(results.size() == queries.size());
      for (size_t i = 0; i < queries.size(); ++i) {
        INFO("query " << i << " of " << queries.size());
        REQUIRE(sameBits(results[i], expected[i]));
      }
    }
  }

  const radar::Scene& scene_;
  radar::CpuSweeper one_, two_, five_;
};

inline std::vector<radar::Query> queriesOf(const radar::tools::Workload& workload, uint32_t scene = 0) {
  std::vector<radar::Query> queries;
  for (const radar::tools::QuerySpec& spec : workload.queries) {
    if (spec.scene == scene) queries.push_back(spec);
  }
  return queries;
}

}  // namespace agreement
