// Who answers hard cases.
#pragma once

#include <string>
#include <vector>

#include "radar/radar.h"

namespace radar::tools {

/// `paper` is the paper's literal min(L), which mode sampled reports beside its own answer.
enum class Method { paper, sampled, contact };
inline constexpr size_t kMethods = 3;
const char* nameOf(Method method);

/// A method and its resolution; 0 in mode contact.
struct Approach {
  Method method = Method::contact;
  uint32_t resolution = 0;
  /// "sampled 64", "contact".
  std::string name() const;
};

/// The paper's own reading of an answer in mode sampled: contact after min(L) if that is within D, now if it is
/// negative. It vouches for no bounds.
Result paperAnswer(const Query& query, const Result& sampled);

/// The queries in the mode and at the resolution that are asked.
std::vector<Query> queriesFor(const Approach& asked, std::vector<Query> queries);
std::vector<Result> answersBy(const Approach& asked, Sweeper& sweeper, const std::vector<Query>& queries);

}  // namespace radar::tools
