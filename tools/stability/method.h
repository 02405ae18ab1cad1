// Who answers in the stability suite.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "radar/radar.h"

namespace radar::tools {

/// `paper` is the paper's literal min(L), which mode sampled tells beside its own answer.
enum class Method { paper, sampled, contact };
inline constexpr size_t kMethods = 3;
const char* nameOf(Method method);

/// The queries in the method's mode; `resolution` is 0 in mode contact.
std::vector<Query> asked(std::vector<Query> queries, Method method, uint32_t resolution);

/// The paper's own reading of an answer in mode sampled: contact after min(L) if that is within D, now if it is
/// negative.
Result paperAnswer(const Query& query, const Result& sampled);

std::vector<Result> answersBy(Method method, Sweeper& sweeper, const std::vector<Query>& queries, uint32_t resolution);

/// hit or overlap.
bool meets(const Result& result);

}  // namespace radar::tools
