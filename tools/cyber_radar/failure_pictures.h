// Pictures of how the sampled method fails.
#pragma once

#include <filesystem>
#include <vector>

#include "stability/page.h"

namespace radar::tools {

/// One for each kind of failure that the run met at kTellingResolution, written into `folder`/stability.
std::vector<StabilityPicture> drawFailures(const Device& device, const StabilityReport& report, uint64_t seed,
                                           const std::filesystem::path& folder);

}  // namespace radar::tools
