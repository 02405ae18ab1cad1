// The families of hard cases asked of every tier, each case among its own objects alone.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "stability/case_run.h"

namespace radar::tools {

/// One family, asked one way.
struct StabilityRow {
  std::string family;
  Approach asked;
  Tally tally;

  uint64_t missed() const { return tally[Fault::missed] + tally.unseen; }
  /// Nothing that the method promises is broken; the paper's min(L) promises nothing.
  bool right() const { return asked.method == Method::paper || tally.wrong == 0; }
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

}  // namespace radar::tools
