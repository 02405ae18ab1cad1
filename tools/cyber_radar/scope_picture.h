// Scopes as pictures that a person can read.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "radar/radar.h"

namespace radar::tools {

/// One scope to draw: `values` as in radar::Scopes, NaN where there is none.
struct ScopePanel {
  std::string title, noValue;  ///< noValue: what a hatched pixel means
  const std::vector<float>* values = nullptr;
  bool markMinimum = false;  ///< rings the first least value and says how much it is
};

/// R, M and L.
std::vector<ScopePanel> panelsOf(const Scopes& scopes);

/// Draws the panels side by side under `title`, each with a scale bar in world units: pixels enlarged by a whole
/// factor, the window's up upwards, hatched where a pixel has no value. Throws std::runtime_error if `file` cannot be
/// written.
void writeScopePicture(const std::filesystem::path& file, const std::string& title, const Scopes& scopes,
                       const std::vector<ScopePanel>& panels);

}  // namespace radar::tools
