#include "stability/method.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace radar::tools {

const char* nameOf(Method method) {
  constexpr std::array<const char*, kMethods> kNames{"paper", "sampled", "contact"};
  return kNames[static_cast<size_t>(method)];
}

std::vector<Query> asked(std::vector<Query> queries, Method method, uint32_t resolution) {
  for (Query& query : queries) {
    query.mode = method == Method::contact ? Mode::contact : Mode::sampled;
    query.resolution = method == Method::contact ? 0 : resolution;
  }
  return queries;
}

Result paperAnswer(const Query& query, const Result& sampled) {
  Result paper = sampled;
  const bool hit = sampled.paperMinL <= query.distance;
  paper.status = hit ? Status::hit : Status::clear;
  paper.t = hit ? std::max(sampled.paperMinL, 0.0) : NAN;
  return paper;
}

std::vector<Result> answersBy(Method method, Sweeper& sweeper, const std::vector<Query>& queries, uint32_t resolution) {
  std::vector<Result> results = sweeper.run(asked(queries, method, resolution));
  if (method != Method::paper) return results;
  for (size_t i = 0; i < results.size(); ++i) results[i] = paperAnswer(queries[i], results[i]);
  return results;
}

bool meets(const Result& result) {
  return result.status == Status::hit || result.status == Status::overlap;
}

}  // namespace radar::tools
