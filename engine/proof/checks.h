// A device's answers about the known scene (proof/known_scene.h), compared with the CPU's.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "gpu/device.h"
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

/// What `check` returns. If it throws an internal error, to which only the device's answers can lead, all `asked` are
/// wrong.
AnswerCheck orAllWrong(const char* kind, size_t asked, const std::function<AnswerCheck()>& check);
/// Compares answers with the CPU's, to the bit. `places`: as of nameOf().
AnswerCheck compared(const char* kind, std::vector<Result> found, std::span<const Result> exact, bool places = false);
/// Mode contact's answers of a Sweeper: first contacts, lists and steps.
std::vector<AnswerCheck> checkSweeper(const Device::Impl& device, uint64_t seed);
/// Those with a clearance.
AnswerCheck checkClearances(const Device::Impl& device, uint64_t seed);
/// Mode sampled's: each bracket holds the exact distance.
AnswerCheck checkSampled(const Device::Impl& device, uint64_t seed);
/// A Recorder's: queries of the CPU and of a host's shaders, beside a host's geometry.
std::vector<AnswerCheck> checkRecorder(const Device::Impl& device, uint64_t seed);
/// Throws Error, naming the device, if a check failed; the reasons say at which stage, and what differs.
void requirePassed(const Device::Impl& device, std::span<const AnswerCheck> checks);

}  // namespace radar
