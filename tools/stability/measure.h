// What the stability suite measures, and its tables.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "measure/case_run.h"
#include "measure/report.h"

namespace radar::tools {

// The families of hard cases asked of every tier, each case among its own objects alone.

/// One family, asked one way.
struct StabilityRow {
  std::string family;
  Approach asked;
  Tally tally;

  uint64_t missed() const { return tally[Fault::missed] + tally.unseen; }
  /// Nothing that the method promises is broken; the paper's min(L) promises nothing.
  bool right() const { return asked.paper || tally.wrong == 0; }
};

struct StabilitySettings {
  std::vector<std::string> families;  ///< none: all
  uint64_t cases = 50'000;            ///< in all, over the families alike
  uint64_t first = 0;                 ///< number of each family's first case
  uint64_t seed = 1;
  std::vector<uint32_t> resolutions{16, 32, 64, 128, 256, 512, 1024};
};

/// `onWrong` receives every broken guarantee and the options that repeat the case; `onProgress` the number of cases
/// just done.
std::vector<StabilityRow> measureStability(const Device& device, const StabilitySettings& settings,
                                           const std::function<void(const std::string&)>& onWrong,
                                           const std::function<void(uint64_t)>& onProgress);

// Without a reference: what leaves the first contact where it is must leave every answer within its bracket.

struct ChangeRow {
  std::string change;
  Approach asked = {};  ///< not the paper's, which has no bracket
  uint64_t cases = 0;
  uint64_t contacts = 0;  ///< cases in which it finds one
  uint64_t broken = 0;    ///< the two answers cannot both be right
};

struct ChangeSettings {
  uint32_t cases = 1024;
  uint64_t seed = 1;
  uint32_t resolution = 64;  ///< of all modes but contact
};

/// Whether a contact can lie in both brackets, or be missing from both. `undecided` agrees with what lies beyond its
/// lo.
bool agree(const Result& one, const Result& other);

/// A row for each change and method. `onBroken` receives the change, the method and the case's number; `onProgress` the
/// number of cases just done.
std::vector<ChangeRow> measureChanges(const Device& device, const ChangeSettings& settings,
                                      const std::function<void(const std::string&)>& onBroken,
                                      const std::function<void(uint64_t)>& onProgress);

// Stability in the plain sense: a sensor's pose moves in tiny steps, and no answer may jump further than the geometry.

struct StepRow {
  std::string family;
  Approach asked = {};
  uint64_t steps = 0;  ///< from pose to pose, where the reference finds contact in both
  uint64_t flips = 0;  ///< steps in which only one of the two contacts is found
  /// The most that t moved in a step beyond what the reference's did, in units of max(size of the sensor, t*).
  double excess = 0;
};

struct StepSettings {
  uint32_t cases = 32;  ///< of each family
  uint32_t steps = 16;  ///< of each case, in one direction
  double size = 1e-6;   ///< of a step, of the sensor's size
  uint64_t seed = 1;
  uint32_t resolution = 64;  ///< of all modes but contact
};

/// `onProgress` receives the number of cases just done.
std::vector<StepRow> measureSteps(const Device& device, const StepSettings& settings,
                                  const std::function<void(uint64_t)>& onProgress);

/// The sums over all families of each way of asking, as rows of the family `all`: counts added up, the worst of the
/// worst.
std::vector<StabilityRow> overFamilies(const std::vector<StabilityRow>& rows);
std::vector<StepRow> overFamilies(const std::vector<StepRow>& rows);

Json tableOf(const std::vector<StabilityRow>& rows);
Json tableOf(const std::vector<StepRow>& rows);
Json tableOf(const std::vector<ChangeRow>& rows);
/// What each family varies: its parameter and the values.
Json tableOf(const std::vector<HardFamily>& families);

}  // namespace radar::tools
