#include "report/timeline.h"

#include <algorithm>

#include "report/axis.h"
#include "report/markup.h"
#include "report/print.h"

namespace radar::tools {

namespace {

constexpr int kColours = 6;

std::string text(double x, double y, const char* style, const std::string& content) {
  return print("<text x=\"%.1f\" y=\"%.1f\" class=\"%s\">", x, y, style) + escaped(content) + "</text>\n";
}

}  // namespace

std::string timeline(const std::string& title, double from, double to, const std::vector<Track>& tracks) {
  constexpr double kNames = 118, kRow = 26, kAxis = 30;
  const double width = 900, height = kRow * static_cast<double>(tracks.size()) + kAxis;
  const auto at = [&](double ms) { return kNames + (width - kNames - 16) * (ms - from) / (to - from); };
  std::string svg = openSvg(print("class=\"timeline\" viewBox=\"0 0 %.0f %.0f\"", width, height), title);
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
