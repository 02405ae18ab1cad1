// An axis: its range, and where its tics are.
#pragma once

#include <string>
#include <vector>

namespace radar::tools {

struct Axis {
  double low = 0, high = 1;
  bool logarithmic = false;
  std::vector<double> tics;

  double share(double value) const;    ///< 0 at its lower end, 1 at the upper
  double valueAt(double share) const;  ///< the inverse; beyond 0 and 1, too
};

/// From 0 to `most` or a little more.
Axis linearAxis(double most);
/// Around both values, which are above 0.
Axis logAxis(double least, double most);

/// 1, 2 or 5 times a power of ten, so that about `steps` of them make `top`.
double niceStep(double top, int steps);

/// "0.5", "10,000", "1e-7".
std::string inTic(double value);

}  // namespace radar::tools
