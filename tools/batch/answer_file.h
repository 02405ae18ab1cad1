// Answer files: JSON Lines, one line per query.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "radar/radar.h"
#include "workloads/workload.h"

namespace radar::tools {

struct Answer {
  Result result;
  AnswerMode mode = AnswerMode::reference;
  std::string reason;  ///< why the status is invalid
  Listed listed;
};

/// The times of an answer, NaN where it has none: distances of the sensor in world units, and fractions.
struct AnswerTimes {
  double t = 0, lo = 0, hi = 0;
  double fraction = 0, fractionLo = 0, fractionHi = 0;  ///< the last two with a motion only
  double time = 0;                                      ///< with a speed only
};
AnswerTimes timesOf(const QuerySpec& query, const Result& result);

/// One line, without its end. All keys of the format are there, with null for what the answer does not have;
/// `paper_min_l` only in mode sampled, `time` only where the query gives a speed, `reason` only where the status is
/// invalid, `hits` and `overlapping` only where the query asks for them, `object_name` only with `objectNames`, which
/// are Workload::objectNames of the query's scene.
std::string answerLine(const QuerySpec& query, const Answer& answer, std::span<const std::string> objectNames = {});

const char* nameOf(Status status);
const char* nameOf(Tier tier);
const char* nameOf(Feature feature);

}  // namespace radar::tools
