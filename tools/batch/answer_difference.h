// How far two answer files agree.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace radar::tools {

struct AnswerDifference {
  uint64_t answers = 0, different = 0;
  double farthest = 0;  ///< the greatest difference of two distances that agree
  std::string first;    ///< the first difference in words; empty if there is none
};

/// Compares two answer files of the same queries: lines of JSON, records in a file .npy, or lines of a shard. Answers
/// agree if their statuses are equal, t is absent in both or differs by at most `within`, and what touches what
/// (object, links, triangles) is equal; likewise their hits, and the objects left out, where both files list them.
/// Throws InputError that names file and row if one is no answer file, or if they do not answer the same queries.
AnswerDifference compareAnswers(const std::filesystem::path& a, const std::filesystem::path& b, double within);

}  // namespace radar::tools
