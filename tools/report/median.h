#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace radar::tools {

/// The middle of the values; of an even number, the mean of the two in the middle; NaN of none.
inline double median(std::vector<double> values) {
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  const size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

}  // namespace radar::tools
