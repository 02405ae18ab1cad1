// The families of workloads/stability.h asked of every tier, and each answer held against the reference.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "stability/method.h"
#include "workloads/stability.h"

namespace radar::tools {

/// One family, one method, one resolution. Lengths are in units of max(size of the sensor, t*).
struct StabilityRow {
  std::string family;
  Method method = Method::contact;
  uint32_t resolution = 0;  ///< 0 in mode contact
  uint64_t cases = 0, contacts = 0;
  uint64_t missed = 0;     ///< contacts within D that it says are none; paper and sampled: or that it does not see
  uint64_t falseHits = 0;  ///< contacts told where there is none within D
  uint64_t brackets = 0;   ///< t* is not in [lo, hi], or t is not
  uint64_t otherwise = 0;  ///< other promises broken: not answered, wrong status, pair, point or normal
  double late = 0;         ///< greatest t - t*
  double early = 0;        ///< greatest t* - t
  double width = 0;        ///< median of hi - lo; NaN without one
  uint64_t bySelect = 0, byPictures = 0, byContact = 0;  ///< settled by: select; sampled; contact
  uint64_t undecided = 0;
  double microseconds = 0;  ///< a query, median over the batches

  /// Nothing that the method promises is broken; the paper's min(L) promises nothing.
  bool right() const;
};

/// How the paper's min(L) and the sampled tier can be wrong.
enum class Failure { missed, falseHit, late, early };

/// The gravest failure of its kind in a family, at kTellingResolution.
struct TellingCase {
  std::string family;
  Method method = Method::paper;
  Failure failure = Failure::missed;
  uint64_t number = 0;
  double amount = 0;  ///< how grave; late and early: as in StabilityRow
};
inline constexpr uint32_t kTellingResolution = 64;

struct StabilitySettings {
  std::vector<std::string> families;  ///< none: all
  uint64_t cases = 50'000;            ///< in all, over the families alike
  uint64_t first = 0;                 ///< number of each family's first case
  uint64_t seed = 1;
  std::vector<uint32_t> resolutions{16, 32, 64, 128, 256, 512, 1024};
};

struct StabilityReport {
  std::vector<StabilityRow> rows;
  std::vector<TellingCase> telling;
  bool right() const;
};

/// Every how many scenes of kCasesPerScene cases are asked at that resolution: from 256 on fewer, as pixels grow more.
uint32_t strideOf(uint32_t resolution);

/// `onWrong` is told every broken promise, and how to ask again; `onProgress` how many cases were just done.
StabilityReport measureStability(const Device& device, const StabilitySettings& settings,
                                 const std::function<void(const std::string&)>& onWrong,
                                 const std::function<void(uint64_t)>& onProgress);

}  // namespace radar::tools
