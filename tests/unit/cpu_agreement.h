// Compares the CPU's search with itself: on one thread and on several, by a sweeper that has followed the scene and by
// a new one, with and without `anyHit`. Other tests compare it with brute force.
#pragma once

#include "radar/cpu_sweeper.h"
#include "support/catch.h"
#include "support/same_bits.h"

namespace agreement {

/// Sweepers of 1, 2 and 5 threads that follow one scene.
class ThreadedSweepers {
 public:
  explicit ThreadedSweepers(const radar::Scene& scene)
      : scene_(scene), one_(scene, 1), two_(scene, 2), five_(scene, 5) {}

  void check(std::vector<radar::Query> queries) {
    const std::vector<radar::Result> exact = compared(queries);
    for (radar::Query& query : queries) {
      query.anyHit = true;
      query.hits = 1;
    }
    const std::vector<radar::Result> decided = compared(queries);
    for (size_t i = 0; i < queries.size(); ++i) {
      INFO("query " << i << " of " << queries.size() << ", anyHit");
      const bool meets = exact[i].status != radar::Status::clear;
      REQUIRE(decided[i].status == (meets ? radar::Status::hit : radar::Status::clear));
      if (!meets) continue;
      REQUIRE(decided[i].lo == 0);
      REQUIRE(decided[i].hi == (queries[i].motion ? 1 : queries[i].distance));
    }
  }

 private:
  std::vector<radar::Result> compared(const std::vector<radar::Query>& queries) {
    const radar::Answers expected = radar::CpuSweeper(scene_, 1).run(queries);
    for (radar::CpuSweeper* sweeper : {&one_, &two_, &five_}) {
      REQUIRE(radar::test::differenceOf(sweeper->run(queries), expected) == "");
    }
    return expected.results;
  }

  const radar::Scene& scene_;
  radar::CpuSweeper one_, two_, five_;
};

}  // namespace agreement
