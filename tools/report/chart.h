// Charts as inline SVG. Colours are CSS classes (c0, c1, ...) of the page, so that it may be light or dark.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace radar::tools {

struct Series {
  std::string name;
  std::vector<double> values;  ///< one for each x
  bool dashed = false;         ///< a line to compare with, not measured
};

/// Lines over `x` from 0 up, each with marks of its own and its name at the end. Not empty.
std::string lineChart(const std::string& title, const std::string& xName, const std::string& yName,
                      const std::vector<double>& x, const std::vector<Series>& series);

struct Bar {
  double from = 0, to = 0;
  int colour = 0;
  std::string tip;
};
struct Track {
  std::string name;
  std::vector<Bar> bars;
};

/// Bars over time in milliseconds, a row for each track, from `from` to `to`.
std::string timeline(const std::string& title, double from, double to, const std::vector<Track>& tracks);

/// For text and attributes.
std::string escaped(std::string_view text);

}  // namespace radar::tools
