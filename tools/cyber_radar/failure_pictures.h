// Pictures of how the sampled method fails: those of docs/stability.md.
#pragma once

#include <filesystem>

#include "radar/radar.h"

namespace radar::tools {

/// Draws a case of each kind of failure into `folder`, whatever else was asked.
void drawFailures(const Device& device, const std::filesystem::path& folder);

}  // namespace radar::tools
