// Answers in words.
#pragma once

#include <string>

#include "cyber_radar/answering.h"

namespace radar::tools {

/// A number for people: six significant digits.
std::string inDigits(double value);
std::string inDigits(const std::array<double, 3>& vector);  ///< (x, y, z)

/// min(L) in words.
std::string leastFreeDistance(const Scopes& scopes);

/// Where the sensor goes, a line or two.
std::string courseInWords(const Query& query);

/// What is hit, where and when, in a few lines; `workload` gives the names.
std::string inWords(const Workload& workload, const QuerySpec& query, const Answer& answer);

/// ": 5 hit, 1 clear"; empty for none.
std::string statusesInWords(const AnsweringStats& stats);

/// What --resolution auto chose: "resolution: 64 to 256"; empty where no picture was drawn.
std::string resolutionsInWords(const AnsweringStats& stats);

}  // namespace radar::tools
