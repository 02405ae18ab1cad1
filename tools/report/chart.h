// Charts of lines and points, drawn by gnuplot, each line with its name beside it.
#pragma once

#include <string>
#include <vector>

namespace radar::tools {

enum class Mark { circle, square, triangle, diamond };

/// A point. `label` stands beside it where there is room, `tip` shows when pointed at.
struct ChartPoint {
  double x = 0, y = 0;  ///< above 0 if Chart::logarithmic; y below Chart::floor is drawn there
  double missed = 0;    ///< above 0: the point stands crossed in the band of misses at this share, whatever y is
  std::string label, tip;
};

/// Points of one kind, in order; its name stands beside one of them.
struct ChartLine {
  std::string name;
  int colour = 0;  ///< c0 to c7 of colours.h; 6 is the ink
  Mark mark = Mark::circle;
  bool hollow = false;
  bool dashed = false;  ///< a line to compare with, without marks
  std::vector<ChartPoint> points;
};

struct Chart {
  std::string title;
  std::vector<std::string> about;  ///< lines below the title
  std::string xName, yName;
  double width = 900, height = 600;
  bool logarithmic = true;  ///< both axes; else both start at 0
  double floor = 0;         ///< above 0: the least y
  std::string floorName;    ///< what a point at the floor means
  std::string missedName;   ///< names the band of misses; empty: there is none
  std::vector<ChartLine> lines;
  std::vector<ChartPoint> front;  ///< by rising x: the staircase below which there is nothing
  std::string frontName;
};

/// For a page of page.h. `id` keeps names inside apart from those of the page's other charts. Points may be none.
/// Throws as gnuplot() does.
std::string inlineSvg(const Chart& chart, const std::string& id);

/// A file of its own: light or dark, as its reader's screen is.
std::string svgFile(const Chart& chart);
/// A file of its own: light, twice the size.
std::string pngFile(const Chart& chart);

}  // namespace radar::tools
