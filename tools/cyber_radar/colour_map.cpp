#include "cyber_radar/colour_map.h"

#include <algorithm>

namespace radar::tools {

Colour viridis(double where) {
  constexpr int kSteps = 8;
  constexpr double kColours[kSteps + 1][3] = {{68, 1, 84},    {71, 44, 122},  {59, 81, 139},
                                              {44, 113, 142}, {33, 144, 141}, {39, 173, 129},
                                              {92, 200, 99},  {170, 220, 50}, {253, 231, 37}};
  const double position = std::clamp(where, 0.0, 1.0) * kSteps;
  const int step = std::min(static_cast<int>(position), kSteps - 1);
  const double rest = position - step;
  Colour colour;
  for (int k = 0; k < 3; ++k) {
    colour[k] = (kColours[step][k] + rest * (kColours[step + 1][k] - kColours[step][k])) / 255;
  }
  return colour;
}

}  // namespace radar::tools
