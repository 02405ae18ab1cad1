// Scopes as pictures that a person can read.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cyber_radar/colour_map.h"
#include "radar/radar.h"

namespace radar::tools {

/// What a pixel can be, where it is not a number.
struct PixelKind {
  Colour colour;
  std::string meaning;
};

/// One scope to draw: `values` as in radar::Scopes, NaN where there is none.
struct ScopePanel {
  std::string title, noValue;  ///< noValue: what a hatched pixel means
  std::vector<float> values;
  bool markMinimum = false;                      ///< rings the first least value and says how much it is
  std::vector<PixelKind> kinds;                  ///< where not empty, values number these, and they are listed below
  std::optional<std::array<double, 2>> contact;  ///< ringed: pixels from the lower left corner
};

/// R, M and L.
std::vector<ScopePanel> panelsOf(const Scopes& scopes);

/// The nearest and farthest of sensor and scene, the bound, and what it settles: where a contact may come no later than
/// `latest`, and where nothing is known. `contact` is the exact answer, ringed where it has a point.
std::vector<ScopePanel> panelsOf(const OuterScopes& scopes, double latest, const Result& contact);

/// Draws the panels side by side under `title`, at most three in a row, each with a scale bar in world units: pixels
/// enlarged by a whole factor, the window's up upwards, hatched where a pixel has no value. All have `width` x `height`
/// pixels. Throws std::runtime_error if `file` cannot be written.
void writeScopePicture(const std::filesystem::path& file, const std::string& title, uint32_t width, uint32_t height,
                       const std::vector<ScopePanel>& panels);

}  // namespace radar::tools
