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

/// The value below which `share` of the values lie: the least at or above that rank. NaN of none.
inline double quantile(const std::vector<double>& values, double share) {
  if (values.empty()) return NAN;
  std::vector<double> sorted(values);
  std::sort(sorted.begin(), sorted.end());
  const auto rank = static_cast<size_t>(std::ceil(share * static_cast<double>(sorted.size())));
  return sorted[std::max<size_t>(rank, 1) - 1];
}

}  // namespace radar::tools
