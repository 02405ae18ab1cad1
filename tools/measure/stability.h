// Where methods are known to fail: the families of hard cases asked of every tier, each case among its own objects
// alone.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "measure/report.h"
#include "radar/radar.h"

namespace radar::tools {

struct StabilitySettings {
  std::vector<std::string> families;  ///< none: all
  uint64_t cases = 50'000;            ///< in all, over the families alike
  uint64_t first = 0;                 ///< number of each family's first case
  uint64_t seed = 1;
  std::vector<uint32_t> resolutions{16, 32, 64, 128, 256, 512, 1024};
};

/// Adds the tables `totals` and `table`, a row for each way of asking, over all families and for each; and `families`,
/// what each varies. `onWrong` receives every broken promise and the options that repeat the case, `onProgress` the
/// number of cases just done. Returns whether no promise is broken; the paper's min(L) promises nothing.
bool measureStability(const Device& device, const StabilitySettings& settings, Json& report,
                      const std::function<void(const std::string&)>& onWrong,
                      const std::function<void(uint64_t)>& onProgress);

}  // namespace radar::tools
