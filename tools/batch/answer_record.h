// Answers as records of one size: a structured array of numpy's.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "batch/answer_file.h"

namespace radar::tools {

/// The members of an answer line, as docs/query-file.md says; NaN and -1 for null.
struct AnswerRecord {
  uint64_t query = 0;  ///< its index
  double t = 0, lo = 0, hi = 0, fraction = 0, fractionLo = 0, fractionHi = 0, time = 0, paperMinL = 0;
  std::array<double, 3> point{}, normal{};
  int64_t object = -1, triA = -1, triB = -1;
  uint8_t status = 0, tier = 0;
  uint8_t featureA = 0, featureB = 0;
  int8_t detected = -1;  ///< -1: not determined
  std::array<uint8_t, 3> padding{};
};
static_assert(sizeof(AnswerRecord) == 152);

AnswerRecord recordOf(uint64_t index, const QuerySpec& query, const Answer& answer);
/// The record's type as numpy writes it.
std::string recordDescription();

}  // namespace radar::tools
