#include "import/float_vertices.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace radar::tools {

namespace {

using Point = std::array<double, 3>;

/// Rounds the vertices about a base and measures what that changes.
FloatVertices rounded(std::span<const double> positions, std::span<const uint32_t> indices, const Point& base) {
  FloatVertices result{{}, base};
  result.positions.reserve(positions.size());
  for (size_t i = 0; i < positions.size(); ++i) {
    result.positions.push_back(static_cast<float>(positions[i] - base[i % 3]));
  }
  const auto changeOf = [&](size_t i) { return std::abs(positions[i] - base[i % 3] - double(result.positions[i])); };
  size_t spoilt = 0;
  for (size_t t = 0; t + 3 <= indices.size(); t += 3) {
    double change = 0, longest = 0;
    for (size_t corner = 0; corner < 3; ++corner) {
      const size_t p = 3 * size_t(indices[t + corner]), q = 3 * size_t(indices[t + (corner + 1) % 3]);
      for (size_t k = 0; k < 3; ++k) {
        change = std::max(change, changeOf(p + k));
        longest = std::max(longest, std::abs(positions[p + k] - positions[q + k]));
      }
    }
    result.change = std::max(result.change, change);
    if (change > 0x1p-12 * longest) ++spoilt;
  }
  result.isSpoilt = 2 * spoilt > indices.size() / 3;
  return result;
}

struct Extent {
  Point low, high;
  double size() const { return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]}); }
};

Extent extentOf(std::span<const double> positions, std::span<const uint32_t> indices) {
  constexpr double kMost = std::numeric_limits<double>::max();
  Extent extent{{kMost, kMost, kMost}, {-kMost, -kMost, -kMost}};
  for (const uint32_t vertex : indices) {
    for (size_t k = 0; k < 3; ++k) {
      extent.low[k] = std::min(extent.low[k], positions[3 * size_t(vertex) + k]);
      extent.high[k] = std::max(extent.high[k], positions[3 * size_t(vertex) + k]);
    }
  }
  return extent;
}

/// A base of few digits, so that differences from it, and poses with it, are exact.
Point baseFor(const Extent& extent) {
  const double size = extent.size(), step = size > 0 ? std::exp2(std::floor(std::log2(size)) - 2) : 0;
  Point base{};
  for (size_t k = 0; k < 3; ++k) {
    const double middle = extent.low[k] + (extent.high[k] - extent.low[k]) / 2;
    base[k] = step > 0 ? std::round(middle / step) * step : middle;
  }
  return base;
}

/// first + a . b, as if in twice the precision (Ogita, Rump and Oishi, "Accurate sum and dot
/// product", 2005).
double sumOf(double first, std::span<const double, 3> a, std::span<const double, 3> b) {
  double sum = first, rest = 0;
  const auto add = [&](double term) {
    const double next = sum + term, of = next - sum;
    rest += (sum - (next - of)) + (term - of);
    sum = next;
  };
  for (size_t k = 0; k < 3; ++k) {
    const double product = a[k] * b[k];
    rest += std::fma(a[k], b[k], -product);
    add(product);
  }
  return sum + rest;
}

}  // namespace

FloatVertices floatVertices(std::span<const double> positions, std::span<const uint32_t> indices) {
  FloatVertices plain = rounded(positions, indices, {});
  if (plain.change == 0) return plain;
  const Extent extent = extentOf(positions, indices);
  if (plain.change <= 0x1p-20 * extent.size() && !plain.isSpoilt) return plain;
  FloatVertices moved = rounded(positions, indices, baseFor(extent));
  const bool isFinite = std::ranges::all_of(moved.positions, [](float x) { return std::isfinite(x); });
  return isFinite && moved.change < plain.change ? moved : plain;
}

Transform aboutBase(const Transform& worldFromFile, const std::array<double, 3>& base) {
  Transform pose = worldFromFile;
  if (base == std::array<double, 3>{}) return pose;
  for (size_t row = 0; row < 3; ++row) {
    double& place = pose.m[4 * row + 3];
    place = sumOf(place, std::span<const double, 3>(&pose.m[4 * row], 3), base);
  }
  return pose;
}

}  // namespace radar::tools
