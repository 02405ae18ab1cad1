// Answers judged by brute force in exact integers.
#pragma once

#include <map>

#include "brute_force.h"
#include "support/answer.h"

namespace oracle {

/// Counts answers, and those that have a fault.
class Judged {
 public:
  int hits = 0, clear = 0, overlaps = 0;
  std::map<std::string, int> faults;

  /// What is wrong with an answer of the CPU, with its lists and, unless it is a step, with its normal.
  void add(const radar::Scene& scene, const radar::Query& query, const radar::Answers& answers, size_t i) {
    const radar::Result& result = answers.results[i];
    const radar::Listed& listed = radar::test::listedBy(answers, i);
    count(faultOf(truthOf(scene, query), query, result, listed.hits, listed.overlapping));
    count(result.tier == radar::Tier::reference ? "" : "not the CPU's tier");
    clear += result.status == radar::Status::clear;
    overlaps += result.status == radar::Status::overlap;
    if (result.status == radar::Status::clear) {
      count(result.t == INFINITY ? "" : "clear at a time");
    } else if (!query.motion && scene.object(result.object).motion == Corner{}) {
      add(scene, query, result);
    } else {
      hits += result.status == radar::Status::hit;
    }
  }

  /// What is wrong with a normal.
  void add(const radar::Scene& scene, const radar::Query& query, const radar::Result& result) {
    if (result.status != radar::Status::hit && result.status != radar::Status::overlap) return;
    count(faultOfNormal(scene, query, result));
    hits += result.status == radar::Status::hit;
  }

  void count(const std::string& fault) {
    if (!fault.empty()) ++faults[fault];
  }
  std::string words() const {
    std::string text =
        std::to_string(hits) + " hits, " + std::to_string(clear) + " clear, " + std::to_string(overlaps) + " overlaps";
    for (const auto& [fault, times] : faults) text += "; " + std::to_string(times) + " times: " + fault;
    return text;
  }
};

}  // namespace oracle
