// Lines and points over logarithmic axes, as inline SVG: see chart.h.
#pragma once

#include <string>
#include <vector>

namespace radar::tools {

/// A point. `label` stands beside it where there is room, `tip` shows when pointed at.
struct LogPoint {
  double x = 0, y = 0;  ///< x > 0; y below LogChart::floor is drawn there
  double missed = 0;    ///< above 0: the point stands in the band of misses at this share, whatever y is
  std::string label, tip;
};

/// Points of one kind, in order; its name stands beside one of them.
struct LogLine {
  std::string name;
  int colour = 0;  ///< c0 to c7; 6 is the ink
  bool hollow = false;
  bool dashed = false;  ///< a line to compare with, without marks
  std::vector<LogPoint> points;
};

struct LogChart {
  std::string title, xName, yName;
  double floor = 0;        ///< above 0: the least y
  std::string floorName;   ///< what a point at the floor means
  std::string missedName;  ///< names the band of misses; empty: there is none
  std::vector<LogLine> lines;
  std::vector<LogPoint> front;  ///< by rising x: the staircase below which there is nothing
};

/// Points may be none.
std::string logChart(const LogChart& chart);

}  // namespace radar::tools
