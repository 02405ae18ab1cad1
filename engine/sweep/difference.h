// In what a device's answer differs from the CPU's.
#pragma once

#include <string>

#include "radar/answers.h"

namespace radar {

/// What a device does for an answer (docs/method.md, "Who is first"), the last first.
enum class Stage {
  none,
  describing,  ///< the numbers of the right contact
  solving,     ///< between which features it is
  searching    ///< whether there is a contact and which: searching or solving, which answers do not tell apart
};
/// In words. `places`: the device has also placed the geometry, with which each of these may begin to differ.
std::string nameOf(Stage stage, bool places);

struct AnswerDifference {
  Stage stage = Stage::none;  ///< the first that the numbers tell of
  /// Each number that differs; of a double which bits do, and by how many units in the last place.
  std::string numbers;
};
/// Of two answers, but for their tiers.
AnswerDifference differenceOf(const Result& found, const Result& exact);

}  // namespace radar
