#include "report/chart.h"

#include <algorithm>
#include <cmath>

#include "report/print.h"

namespace radar::tools {

namespace {

constexpr double kWidth = 440, kHeight = 340, kLeft = 58, kRight = 84, kTop = 14, kBottom = 48;
constexpr int kColours = 6;

// 1, 2 or 5 times a power of ten, so that about `steps` of them make `top`.
double niceStep(double top, int steps) {
  const double power = std::pow(10, std::floor(std::log10(top / steps)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (top <= step * power * steps) return step * power;
  }
  return 10 * power;
}

std::string openSvg(const std::string& title, double width, double height) {
  return print("<svg viewBox=\"0 0 %.0f %.0f\" role=\"img\" aria-label=\"", width, height) + escaped(title) +
         "\"><title>" + escaped(title) + "</title>\n";
}

std::string text(double x, double y, const char* style, const std::string& content) {
  return print("<text x=\"%.1f\" y=\"%.1f\" class=\"%s\">", x, y, style) + escaped(content) + "</text>\n";
}

std::string mark(double x, double y, int kind) {
  const char* style = kind == 0   ? "c0"
                      : kind == 1 ? "c1"
                      : kind == 2 ? "c2"
                      : kind == 3 ? "c3"
                      : kind == 4 ? "c4"
                                  : "c5";
  switch (kind % 3) {
    case 0:
      return print("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" class=\"mark %s\"/>", x, y, style);
    case 1:
      return print("<rect x=\"%.1f\" y=\"%.1f\" width=\"8\" height=\"8\" class=\"mark %s\"/>", x - 4, y - 4, style);
    default:
      return print("<path d=\"M%.1f %.1fl5 9h-10z\" class=\"mark %s\"/>", x, y - 5, style);
  }
}

// Where the names at the lines' ends stand: at the last value, pushed apart.
std::vector<double> labelHeights(const std::vector<double>& ends) {
  constexpr double kLine = 15;
  std::vector<size_t> order(ends.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return ends[a] < ends[b]; });
  std::vector<double> heights = ends;
  for (size_t i = 1; i < order.size(); ++i) {
    heights[order[i]] = std::max(heights[order[i]], heights[order[i - 1]] + kLine);
  }
  return heights;
}

}  // namespace

std::string escaped(std::string_view content) {
  std::string out;
  for (const char c : content) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '"') {
      out += "&quot;";
    } else {
      out += c;
    }
  }
  return out;
}

std::string lineChart(const std::string& title, const std::string& xName, const std::string& yName,
                      const std::vector<double>& x, const std::vector<Series>& series) {
  double top = 0;
  for (const Series& line : series) top = std::max(top, *std::max_element(line.values.begin(), line.values.end()));
  if (!(top > 0)) top = 1;
  const double step = niceStep(top, 5), xStep = niceStep(x.back() > 0 ? x.back() : 1, 6);
  const double yMost = step * std::ceil(top / step - 1e-9), xMost = xStep * std::ceil(x.back() / xStep - 1e-9);
  const auto atX = [&](double value) { return kLeft + (kWidth - kLeft - kRight) * value / xMost; };
  const auto atY = [&](double value) { return kHeight - kBottom - (kHeight - kTop - kBottom) * value / yMost; };
  std::string svg = openSvg(title, kWidth, kHeight);
  for (double y = 0; y <= yMost * 1.0001; y += step) {
    svg += print("<path d=\"M%.1f %.1fH%.1f\" class=\"grid\"/>", kLeft, atY(y), kWidth - kRight);
    svg += text(kLeft - 8, atY(y) + 4, "end", print("%g", std::round(y * 1e6) / 1e6));
  }
  for (double value = 0; value <= xMost * 1.0001; value += xStep) {
    svg += text(atX(value), kHeight - kBottom + 18, "middle", print("%g", value));
  }
  svg += text(0.5 * (kLeft + kWidth - kRight), kHeight - 8, "middle", xName);
  svg +=
      print("<text transform=\"translate(14 %.1f) rotate(-90)\" class=\"middle\">", 0.5 * (kTop + kHeight - kBottom)) +
      escaped(yName) + "</text>\n";
  std::vector<double> ends;
  for (const Series& line : series) ends.push_back(atY(line.values.back()));
  const std::vector<double> heights = labelHeights(ends);
  int colour = 0;
  for (size_t s = 0; s < series.size(); ++s) {
    const Series& line = series[s];
    const std::string style = line.dashed ? "ideal" : print("line c%d", colour % kColours);
    std::string path;
    for (size_t i = 0; i < x.size(); ++i) {
      path += print("%c%.1f %.1f", i == 0 ? 'M' : 'L', atX(x[i]), atY(line.values[i]));
    }
    svg += "<path d=\"" + path + "\" class=\"" + style + "\"/>\n";
    if (!line.dashed) {
      for (size_t i = 0; i < x.size(); ++i) svg += mark(atX(x[i]), atY(line.values[i]), colour % kColours);
      ++colour;
    }
    svg += text(atX(x.back()) + 10, heights[s] + 4, "start", line.name);
  }
  return svg + "</svg>\n";
}

std::string timeline(const std::string& title, double from, double to, const std::vector<Track>& tracks) {
  constexpr double kNames = 118, kRow = 26, kAxis = 30;
  const double width = 900, height = kRow * static_cast<double>(tracks.size()) + kAxis;
  const auto at = [&](double ms) { return kNames + (width - kNames - 16) * (ms - from) / (to - from); };
  std::string svg = openSvg(title, width, height);
  const double step = niceStep(to - from, 8);
  for (double ms = 0; ms <= to - from; ms += step) {
    svg += print("<path d=\"M%.1f 0V%.1f\" class=\"grid\"/>", at(from + ms), height - kAxis + 4);
    svg += text(at(from + ms), height - 10, "middle", print("%g ms", ms));
  }
  for (size_t i = 0; i < tracks.size(); ++i) {
    const double y = kRow * static_cast<double>(i);
    svg += text(0, y + 17, "start", tracks[i].name);
    for (const Bar& bar : tracks[i].bars) {
      svg += print("<rect x=\"%.2f\" y=\"%.1f\" width=\"%.2f\" height=\"%.0f\" class=\"bar c%d\"><title>", at(bar.from),
                   y + 3, std::max(0.4, at(bar.to) - at(bar.from)), kRow - 6, bar.colour % kColours) +
             escaped(bar.tip) + "</title></rect>\n";
    }
  }
  return svg + "</svg>\n";
}

}  // namespace radar::tools
