#include "batch/answer_record.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>

namespace radar::tools {

namespace {

static_assert(std::endian::native == std::endian::little);
static_assert(offsetof(AnswerRecord, t) == 8 && offsetof(AnswerRecord, point) == 72 &&
              offsetof(AnswerRecord, object) == 120 && offsetof(AnswerRecord, status) == 144 &&
              offsetof(AnswerRecord, padding) == 149);

// As in an answer line, infinities are none.
double finiteOr(double value) {
  return std::isfinite(value) ? value : std::numeric_limits<double>::quiet_NaN();
}

std::array<double, 3> finiteOr(const std::array<double, 3>& vector) {
  if (std::isnan(vector[0])) return {vector[0], vector[0], vector[0]};
  return {finiteOr(vector[0]), finiteOr(vector[1]), finiteOr(vector[2])};
}

int64_t idOr(uint32_t id) {
  return id == kNone ? -1 : int64_t{id};
}

}  // namespace

AnswerRecord recordOf(uint64_t index, const QuerySpec& query, const Answer& answer) {
  const Result& result = answer.result;
  const AnswerTimes times = timesOf(query, result);
  AnswerRecord record;
  record.query = index;
  record.t = finiteOr(times.t);
  record.lo = finiteOr(times.lo);
  record.hi = finiteOr(times.hi);
  record.fraction = finiteOr(times.fraction);
  record.fractionLo = finiteOr(times.fractionLo);
  record.fractionHi = finiteOr(times.fractionHi);
  record.time = finiteOr(times.time);
  record.paperMinL = finiteOr(answer.mode == AnswerMode::sampled ? result.paperMinL : std::nan(""));
  record.point = finiteOr(result.point);
  record.normal = finiteOr(result.normal);
  record.object = idOr(result.object);
  record.triA = idOr(result.triA);
  record.triB = idOr(result.triB);
  record.status = static_cast<uint8_t>(result.status);
  record.tier = static_cast<uint8_t>(result.tier);
  record.featureA = static_cast<uint8_t>(result.featureA);
  record.featureB = static_cast<uint8_t>(result.featureB);
  record.detected = result.detected == Detected::no ? 0 : result.detected == Detected::yes ? 1 : -1;
  return record;
}

std::string recordDescription() {
  std::string text = "[('query', '<u8'), ";
  for (const char* name : {"t", "lo", "hi", "fraction", "fraction_lo", "fraction_hi", "time", "paper_min_l"}) {
    text += "('" + std::string(name) + "', '<f8'), ";
  }
  text += "('point', '<f8', (3,)), ('normal', '<f8', (3,)), ('object', '<i8'), ('tri_a', '<i8'), ('tri_b', '<i8'), ";
  for (const char* name : {"status", "tier", "feature_a", "feature_b"})
    text += "('" + std::string(name) + "', '|u1'), ";
  return text + "('detected', '|i1'), ('', '|V3')]";
}

}  // namespace radar::tools
