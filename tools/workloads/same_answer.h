#pragma once

#include <cmath>

#include "radar/radar.h"

namespace radar::tools {

/// Whether two answers to one query agree in status, t, object, triangles, features, point and normal, to the bit but
/// for the sign of 0.
inline bool sameAnswer(const Result& a, const Result& b) {
  const auto same = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  bool all = a.status == b.status && a.object == b.object && a.triA == b.triA && a.triB == b.triB &&
             a.featureA == b.featureA && a.featureB == b.featureB && same(a.t, b.t);
  for (int k = 0; k < 3; ++k) all = all && same(a.point[k], b.point[k]) && same(a.normal[k], b.normal[k]);
  return all;
}

}  // namespace radar::tools
