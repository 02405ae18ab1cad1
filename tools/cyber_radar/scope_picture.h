// Scopes as pictures that a person can read.
#pragma once

#include <filesystem>
#include <string>

#include "radar/radar.h"

namespace radar::tools {

/// Draws those of R, M and L that `which` names, side by side under `title`, each with a scale bar in world units:
/// pixels enlarged by a whole factor, the window's up upwards, hatched where a pixel has no value, the least L ringed.
/// Throws std::runtime_error if `file` cannot be written.
void writeScopePicture(const std::filesystem::path& file, const std::string& title, const Scopes& scopes,
                       const std::string& which = "RML");

/// min(L) in words.
std::string leastFreeDistance(const Scopes& scopes);

}  // namespace radar::tools
