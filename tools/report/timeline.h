// Bars over time, as inline SVG. Colours are CSS classes (c0, c1, ...) of the page, so that it may be light or dark.
#pragma once

#include <string>
#include <vector>

namespace radar::tools {

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

}  // namespace radar::tools
