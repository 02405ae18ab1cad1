#include "stability/method.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace radar::tools {

const char* nameOf(Method method) {
  constexpr std::array<const char*, kMethods> kNames{"paper", "sampled", "contact"};
  return kNames[static_cast<size_t>(method)];
}

std::string Approach::name() const {
  return method == Method::contact ? nameOf(method) : nameOf(method) + (" " + std::to_string(resolution));
}

Result paperAnswer(const Query& query, const Result& sampled) {
  Result paper = sampled;
  const bool hit = sampled.paperMinL <= query.distance;
  paper.status = hit ? Status::hit : Status::clear;
  paper.t = hit ? std::max(sampled.paperMinL, 0.0) : NAN;
  paper.lo = paper.hi = NAN;
  return paper;
}

std::vector<Query> queriesFor(const Approach& asked, std::vector<Query> queries) {
  for (Query& query : queries) {
    query.mode = asked.method == Method::contact ? Mode::contact : Mode::sampled;
    query.resolution = asked.resolution;
  }
  return queries;
}

std::vector<Result> answersBy(const Approach& asked, Sweeper& sweeper, const std::vector<Query>& queries) {
  std::vector<Result> results = sweeper.run(queriesFor(asked, queries));
  if (asked.method != Method::paper) return results;
  for (size_t i = 0; i < results.size(); ++i) results[i] = paperAnswer(queries[i], results[i]);
  return results;
}

}  // namespace radar::tools
