#include "cyber_radar/scope_picture.h"

#include <algorithm>
#include <cmath>

#include "cyber_radar/canvas.h"
#include "cyber_radar/words.h"

namespace radar::tools {

namespace {

constexpr double kSide = 512;  // what the longer side of a small scope is enlarged towards
constexpr double kMargin = 16, kTitle = 34, kPanelTitle = 22, kCaption = 40;
constexpr double kBarGap = 12, kBarWidth = 18, kBarText = 96;
constexpr double kLeastWidth = 330;  // of a panel's picture, so that titles and captions find room
constexpr int kTicks = 5;

struct Range {
  double low = 0, high = 0;
  size_t lowest = 0;  ///< the first pixel of the least value
  bool empty = true;
};

Range rangeOf(const std::vector<float>& values) {
  Range range;
  for (size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) continue;
    if (range.empty || values[i] < range.low) {
      range.low = values[i];
      range.lowest = i;
    }
    range.high = range.empty ? values[i] : std::max(range.high, double(values[i]));
    range.empty = false;
  }
  return range;
}

void hatch(const Canvas& canvas, double x, double y, double width, double height) {
  cairo_t* cairo = canvas.get();
  canvas.colour({0.93, 0.93, 0.93});
  canvas.fill(x, y, width, height);
  cairo_save(cairo);
  cairo_rectangle(cairo, x, y, width, height);
  cairo_clip(cairo);
  canvas.colour({0.8, 0.8, 0.8});
  cairo_set_line_width(cairo, 1);
  for (double offset = -height; offset < width; offset += 8) {
    cairo_move_to(cairo, x + offset, y + height);
    cairo_line_to(cairo, x + offset + height, y);
  }
  cairo_stroke(cairo);
  cairo_restore(cairo);
}

/// A scale bar from `range.low` at the bottom to `range.high` at the top.
void drawBar(const Canvas& canvas, const Range& range, double x, double y, double height) {
  const int rows = static_cast<int>(height);
  for (int row = 0; row < rows; ++row) {
    canvas.colour(viridis(1 - (row + 0.5) / rows));
    canvas.fill(x, y + row, kBarWidth, 1);
  }
  canvas.outline(x, y, kBarWidth, rows);
  const int ticks = range.high > range.low ? kTicks : 1;
  for (int i = 0; i < ticks; ++i) {
    const double part = ticks == 1 ? 0.5 : double(i) / (ticks - 1);
    const double level = y + (1 - part) * rows;
    canvas.colour({0.3, 0.3, 0.3});
    canvas.fill(x + kBarWidth, level - 0.5, 5, 1);
    canvas.text(x + kBarWidth + 9, level + 4, 12, inDigits(range.low + part * (range.high - range.low)));
  }
}

/// A ring and a cross hair that leave the pixel itself free, light on dark so that they show on any colour.
void drawMark(const Canvas& canvas, double x, double y, double pixel) {
  const double radius = std::max(9.0, 1.5 * pixel);
  for (const auto& [width, colour] : {std::pair{4.0, Colour{0, 0, 0}}, std::pair{2.0, Colour{1, 1, 1}}}) {
    canvas.colour(colour);
    cairo_set_line_width(canvas.get(), width);
    cairo_new_path(canvas.get());
    cairo_arc(canvas.get(), x, y, radius, 0, 2 * std::acos(-1.0));
    for (const auto& [dx, dy] : {std::pair{1, 0}, std::pair{-1, 0}, std::pair{0, 1}, std::pair{0, -1}}) {
      cairo_move_to(canvas.get(), x + radius * dx, y + radius * dy);
      cairo_line_to(canvas.get(), x + 1.8 * radius * dx, y + 1.8 * radius * dy);
    }
    cairo_stroke(canvas.get());
  }
}

/// One scope to draw: `values` as in radar::Scopes, NaN where there is none.
struct Panel {
  char name;
  const char *title, *noValue;  ///< noValue: what a hatched pixel means
  const std::vector<float>& values;
};

void drawPanel(const Canvas& canvas, const Scopes& scopes, const Panel& panel, double pixel, double x, double y) {
  const std::vector<float>& values = panel.values;
  const double width = pixel * scopes.width, height = pixel * scopes.height;
  const Range range = rangeOf(values);
  canvas.text(x, y + 15, 15, panel.title);
  y += kPanelTitle;
  hatch(canvas, x, y, width, height);
  const double span = range.high > range.low ? range.high - range.low : 1;
  for (size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) continue;
    canvas.colour(viridis(range.high > range.low ? (values[i] - range.low) / span : 0.5));
    const size_t column = i % scopes.width, row = i / scopes.width;
    canvas.fill(x + pixel * double(column), y + height - pixel * double(row + 1), pixel, pixel);
  }
  canvas.outline(x, y, width, height);
  const double below = y + height + 17;
  if (range.empty) {
    canvas.text(x, below, 12, std::string("no pixel has a value: ") + panel.noValue);
    return;
  }
  drawBar(canvas, range, x + width + kBarGap, y, height);
  canvas.text(x, below, 12, std::string("world units; hatched: ") + panel.noValue);
  if (panel.name != 'L') return;
  const size_t column = range.lowest % scopes.width, row = range.lowest / scopes.width;
  drawMark(canvas, x + pixel * (double(column) + 0.5), y + height - pixel * (double(row) + 0.5), pixel);
  canvas.text(x, below + 16, 12,
              "least value " + inDigits(range.low) + " at pixel (" + std::to_string(column) + ", " +
                  std::to_string(row) + "), ringed");
}

}  // namespace

void writeScopePicture(const std::filesystem::path& file, const std::string& title, const Scopes& scopes,
                       const std::string& which) {
  std::vector<Panel> panels;
  for (const Panel& panel : {Panel{'R', "R: from the back plane to the scene", "nothing there", scopes.R},
                             Panel{'M', "M: from the far end back to the sensor", "no sensor there", scopes.M},
                             Panel{'L', "L = R + M - d: free distance", "sensor or scene missing", scopes.L}}) {
    if (which.find(panel.name) != which.npos) panels.push_back(panel);
  }
  const double pixel = std::max(1.0, std::floor(kSide / std::max({scopes.width, scopes.height, 1u})));
  const double step = std::max(pixel * scopes.width, kLeastWidth) + kBarGap + kBarWidth + kBarText + kMargin;
  const Canvas canvas(kMargin + step * double(panels.size()),
                      2 * kMargin + kTitle + kPanelTitle + pixel * scopes.height + kCaption);
  canvas.text(kMargin, kMargin + 17, 17, title);
  for (size_t i = 0; i < panels.size(); ++i) {
    drawPanel(canvas, scopes, panels[i], pixel, kMargin + step * double(i), kMargin + kTitle);
  }
  canvas.write(file);
}

std::string leastFreeDistance(const Scopes& scopes) {
  return std::isnan(scopes.result.paperMinL) ? "none" : inDigits(scopes.result.paperMinL);
}

}  // namespace radar::tools
