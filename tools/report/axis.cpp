#include "report/axis.h"

#include <cmath>

#include "report/print.h"

namespace radar::tools {

double Axis::share(double value) const {
  return logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
}

double Axis::valueAt(double share) const {
  return logarithmic ? low * std::pow(high / low, share) : low + share * (high - low);
}

double niceStep(double top, int steps) {
  const double power = std::pow(10, std::floor(std::log10(top / steps)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (top <= step * power * steps) return step * power;
  }
  return 10 * power;
}

Axis linearAxis(double most) {
  if (!(most > 0)) most = 1;
  const double step = niceStep(most, 6);
  const double count = std::ceil(most / step - 1e-9);
  Axis axis{0, step * count, false, {}};
  for (double i = 0; i <= count; ++i) axis.tics.push_back(step * i);
  return axis;
}

Axis logAxis(double least, double most) {
  // A little room on both sides, and more than a point.
  const double room = std::max(1.1, std::pow(most / least, 0.03));
  Axis axis{least / room, most * room, true, {}};
  const double decades = std::log10(axis.high / axis.low);
  const int every = decades > 8 ? static_cast<int>(std::ceil(decades / 6)) : 1;
  for (int exponent = static_cast<int>(std::floor(std::log10(axis.low))); exponent <= std::log10(axis.high);
       exponent += 1) {
    if (exponent % every != 0 && decades > 8) continue;
    for (const double factor : {1.0, 2.0, 3.0, 5.0, 7.0}) {
      const double tic = factor * std::pow(10, exponent);
      const bool wanted = factor == 1 || decades < 1 || (decades < 2 && (factor == 2 || factor == 5));
      if (wanted && tic >= axis.low && tic <= axis.high) axis.tics.push_back(tic);
    }
  }
  return axis;
}

std::string inTic(double value) {
  const double exponent = std::round(std::log10(value));
  const bool isPower = value > 0 && std::abs(value / std::pow(10, exponent) - 1) < 1e-9;
  if (isPower && (exponent < -3 || exponent > 6)) return print("1e%.0f", exponent);
  std::string text = print("%.7g", value);
  if (text.find('e') != std::string::npos) return text;
  const size_t whole = std::min(text.find('.'), text.size());
  for (size_t at = whole; at > 3; at -= 3) text.insert(at - 3, ",");
  return text;
}

}  // namespace radar::tools
