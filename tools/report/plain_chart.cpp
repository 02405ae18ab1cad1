#include "report/plain_chart.h"

#include <algorithm>
#include <cmath>

#include "report/axis.h"
#include "report/markup.h"
#include "report/print.h"

namespace radar::tools {

namespace {

constexpr double kLeft = 64, kTop = 34, kBottom = 44, kName = 7.5;

std::string text(double x, double y, const std::string& style, const std::string& content) {
  return print("<text x=\"%.1f\" y=\"%.1f\" %s>", x, y, style.c_str()) + escaped(content) + "</text>\n";
}

// Names at the ends of lines, apart from each other.
std::vector<double> apart(std::vector<double> ends) {
  constexpr double kLine = 16;
  std::vector<size_t> order(ends.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](size_t i, size_t j) { return ends[i] < ends[j]; });
  for (size_t i = 1; i < order.size(); ++i) ends[order[i]] = std::max(ends[order[i]], ends[order[i - 1]] + kLine);
  return ends;
}

}  // namespace

std::string plainSvg(const Chart& chart) {
  double leastX = INFINITY, mostX = 0, leastY = INFINITY, mostY = 0, right = 16;
  for (const ChartLine& line : chart.lines) {
    right = std::max(right, 20 + kName * static_cast<double>(line.name.size()));
    for (const ChartPoint& point : line.points) {
      leastX = std::min(leastX, point.x);
      mostX = std::max(mostX, point.x);
      leastY = std::min(leastY, point.y);
      mostY = std::max(mostY, point.y);
    }
  }
  const bool isEmpty = mostX <= 0;
  const Axis x = isEmpty ? logAxis(1, 10) : logAxis(leastX, mostX);
  const Axis y = isEmpty ? logAxis(1, 10) : logAxis(leastY, std::max(mostY, 2 * leastY));
  const double bottom = chart.height - kBottom, end = chart.width - right;
  const auto xOf = [&](double value) { return kLeft + (end - kLeft) * x.share(value); };
  const auto yOf = [&](double value) { return bottom - (bottom - kTop) * y.share(value); };

  std::string svg =
      openSvg(print("class=\"timeline\" viewBox=\"0 0 %.0f %.0f\"", chart.width, chart.height), chart.title);
  svg += text(0, 16, "style=\"font-weight:600\"", chart.title);
  for (const double tic : y.tics) {
    svg += print("<path d=\"M%.1f %.1fH%.1f\" class=\"grid\"/>", kLeft, yOf(tic), end);
    svg += text(kLeft - 6, yOf(tic) + 4, "text-anchor=\"end\"", inTic(tic));
  }
  for (const double tic : x.tics) svg += text(xOf(tic), bottom + 18, "class=\"middle\"", inTic(tic));
  svg += text(end, bottom + 36, "text-anchor=\"end\"", chart.xName);
  svg += text(kLeft, kTop - 4, "", chart.yName);
  std::vector<double> ends;
  for (const ChartLine& line : chart.lines) ends.push_back(line.points.empty() ? 0 : yOf(line.points.back().y));
  ends = apart(ends);
  for (size_t i = 0; i < chart.lines.size(); ++i) {
    const ChartLine& line = chart.lines[i];
    if (line.points.empty()) continue;
    std::string path;
    for (const ChartPoint& point : line.points) {
      path += print("%c%.1f %.1f", path.empty() ? 'M' : 'L', xOf(point.x), yOf(point.y));
    }
    svg += print("<path d=\"%s\" style=\"fill:none;stroke:var(--c%d);stroke-width:2\"/>\n", path.c_str(), line.colour);
    for (const ChartPoint& point : line.points) {
      svg += print("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" style=\"fill:var(--c%d)\"><title>", xOf(point.x),
                   yOf(point.y), line.colour) +
             escaped(point.tip) + "</title></circle>\n";
    }
    svg +=
        text(xOf(line.points.back().x) + 10, ends[i] + 4, print("style=\"fill:var(--c%d)\"", line.colour), line.name);
  }
  return svg + "</svg>\n";
}

}  // namespace radar::tools
