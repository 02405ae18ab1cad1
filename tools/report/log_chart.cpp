#include "report/log_chart.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "report/chart.h"
#include "report/print.h"

namespace radar::tools {

namespace {

constexpr double kWidth = 620, kHeight = 470, kLeft = 74, kRight = 26, kTop = 12, kBottom = 50, kBand = 84;
constexpr double kLineHeight = 15, kCharacter = 6.9, kReach = 8;
// The shares of misses that the band shows, from its lower edge up.
constexpr double kLeastMissed = 0.003, kMostMissed = 1;

struct Box {
  double left, top, right, bottom;
  double overlap(const Box& other) const {
    const double across = std::min(right, other.right) - std::max(left, other.left);
    const double down = std::min(bottom, other.bottom) - std::max(top, other.top);
    return across > 0 && down > 0 ? across * down : 0;
  }
};

struct Range {
  double low, high;
  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double share(double value) const { return std::log(value / low) / std::log(high / low); }
};

// Whole powers of ten around what was taken, or 1, 2, 5 steps where that would be mostly empty.
Range widened(const Range& range) {
  Range wide{std::pow(10, std::floor(std::log10(range.low) + 1e-9)),
             std::pow(10, std::ceil(std::log10(range.high) - 1e-9))};
  for (const double factor : {5.0, 2.0}) {
    if (wide.low * factor <= range.low * 0.999) {
      wide.low *= factor;
      break;
    }
  }
  for (const double factor : {5.0, 2.0}) {
    if (wide.high / factor >= range.high * 1.001) {
      wide.high /= factor;
      break;
    }
  }
  if (wide.high <= wide.low) wide.high = wide.low * 10;
  return wide;
}

std::string power(double value) {
  const double exponent = std::log10(value);
  if (value >= 0.001 && value < 1e6) return print("%g", value);
  return print("1e%.0f", exponent);
}

std::string sayingShare(double share) {
  return share < 0.01 ? print("%.1f%%", 100 * share) : print("%.0f%%", 100 * share);
}

class Drawing {
 public:
  explicit Drawing(const LogChart& chart) : chart_(chart) {
    Range x{INFINITY, 0}, y{INFINITY, 0};
    if (chart.floor > 0) y.take(chart.floor);
    for (const LogLine& line : chart.lines) {
      for (const LogPoint& point : line.points) {
        x.take(point.x);
        if (!(point.missed > 0)) y.take(std::max(point.y, chart.floor));
      }
    }
    if (x.high == 0) x = {1, 10};
    if (y.high == 0) y = {0.1, 1};
    x_ = widened(x);
    y_ = widened(y);
    if (chart.floor > 0) y_.low = chart.floor;
    top_ = kTop + (chart.missedName.empty() ? 0 : kBand);
  }

  std::string draw() {
    svg_ = print("<svg viewBox=\"0 0 %.0f %.0f\" role=\"img\" aria-label=\"", kWidth, kHeight) + escaped(chart_.title) +
           "\"><title>" + escaped(chart_.title) + "</title>\n";
    drawGrid();
    if (!chart_.missedName.empty()) drawBand();
    drawFront();
    for (const LogLine& line : chart_.lines) drawLine(line);
    for (const LogLine& line : chart_.lines) nameLine(line);
    for (const LogLine& line : chart_.lines) {
      for (const LogPoint& point : line.points) labelPoint(line, point);
    }
    return svg_ + "</svg>\n";
  }

 private:
  double atX(double x) const { return kLeft + (kWidth - kLeft - kRight) * x_.share(x); }
  double atY(const LogPoint& point) const {
    if (point.missed > 0) {
      const Range band{kLeastMissed, kMostMissed};
      return top_ - 12 - (kBand - 34) * band.share(std::clamp(point.missed, kLeastMissed, kMostMissed));
    }
    return heightOf(std::max(point.y, y_.low));
  }
  double heightOf(double y) const { return kHeight - kBottom - (kHeight - kBottom - top_) * y_.share(y); }

  void text(double x, double y, const char* style, const std::string& content) {
    svg_ += print("<text x=\"%.1f\" y=\"%.1f\" class=\"%s\">", x, y, style) + escaped(content) + "</text>\n";
  }

  void tickAt(double x) {
    if (x < x_.low * 0.999 || x > x_.high * 1.001) return;
    svg_ += print("<path d=\"M%.1f %.1fV%.1f\" class=\"grid\"/>", atX(x), kTop, kHeight - kBottom);
    text(atX(x), kHeight - kBottom + 18, "middle", power(x));
  }

  void drawGrid() {
    const double decades = std::log10(y_.high / y_.low);
    const double every = decades > 8 ? 1000 : 10;
    for (double y = std::pow(10, std::ceil(std::log10(y_.low) - 1e-9)); y <= y_.high * 1.001; y *= every) {
      svg_ += print("<path d=\"M%.1f %.1fH%.1f\" class=\"grid\"/>", kLeft, heightOf(y), kWidth - kRight);
      text(kLeft - 8, heightOf(y) + 4, "end", power(y));
    }
    for (double x = std::pow(10, std::floor(std::log10(x_.low) + 1e-9)); x <= x_.high * 1.001; x *= 10) {
      tickAt(x);
      if (x_.high / x_.low > 100) continue;
      tickAt(2 * x);
      tickAt(5 * x);
    }
    text(0.5 * (kLeft + kWidth - kRight), kHeight - 8, "middle", chart_.xName);
    svg_ += print("<text transform=\"translate(16 %.1f) rotate(-90)\" class=\"middle\">",
                  0.5 * (top_ + kHeight - kBottom)) +
            escaped(chart_.yName) + "</text>\n";
    if (!chart_.floorName.empty()) {
      const double y = heightOf(y_.low);
      svg_ += print("<path d=\"M%.1f %.1fH%.1f\" class=\"ideal\"/>", kLeft, y, kWidth - kRight);
      place(chart_.floorName, "end soft",
            {kWidth - kRight - 4 - widthOf(chart_.floorName), y - 22, kWidth - kRight - 4, y - 7});
    }
  }

  void drawBand() {
    svg_ += print("<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" class=\"band\"/>", kLeft, kTop,
                  kWidth - kLeft - kRight, kBand - 4);
    text(kLeft + 6, kTop + 14, "start soft", chart_.missedName);
    taken_.push_back({kLeft, kTop, kLeft + 6 + widthOf(chart_.missedName), kTop + 17});
    for (const double share : {0.01, 0.1, 1.0}) {
      text(kLeft - 8, atY({.missed = share}) + 4, "end", sayingShare(share));
    }
  }

  void drawFront() {
    if (chart_.front.empty()) return;
    std::string path = print("M%.1f %.1f", atX(chart_.front[0].x), kTop);
    for (const LogPoint& point : chart_.front) path += print("H%.1fV%.1f", atX(point.x), atY(point));
    svg_ += "<path d=\"" + path + print("H%.1f\" class=\"front\"/>\n", kWidth - kRight);
  }

  void drawLine(const LogLine& line) {
    std::string path;
    for (const LogPoint& point : line.points) {
      path += print("%c%.1f %.1f", path.empty() ? 'M' : 'L', atX(point.x), atY(point));
    }
    if (line.points.size() > 1) {
      svg_ +=
          "<path d=\"" + path +
          (line.dashed ? std::string("\" class=\"ideal\"/>\n") : print("\" class=\"line thin c%d\"/>\n", line.colour));
    }
    for (size_t i = 0; i + 1 < line.points.size(); ++i) keepClear(line.points[i], line.points[i + 1]);
    if (line.dashed) return;
    for (const LogPoint& point : line.points) {
      const double x = atX(point.x), y = atY(point);
      svg_ += print("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"5\" class=\"%s c%d\"><title>", x, y,
                    line.hollow ? "hollow" : "mark", line.colour) +
              escaped(point.tip) + "</title></circle>\n";
      if (point.missed > 0) {
        svg_ += print("<path d=\"M%.1f %.1fl8 8m0 -8l-8 8\" class=\"cross c%d\"/>", x - 4, y - 4, line.colour);
      }
      taken_.push_back({x - 5, y - 5, x + 5, y + 5});
    }
  }

  // Names had better not stand on a line.
  void keepClear(const LogPoint& from, const LogPoint& to) {
    constexpr double kStep = 4;
    const double x = atX(from.x), y = atY(from), dx = atX(to.x) - x, dy = atY(to) - y;
    const double steps = std::ceil(std::hypot(dx, dy) / kStep);
    for (double i = 0; i < steps; ++i) {
      const double u = x + dx * i / steps, v = y + dy * i / steps;
      taken_.push_back({u - 1.5, v - 1.5, u + 1.5, v + 1.5});
    }
  }

  static double widthOf(const std::string& content) { return kCharacter * static_cast<double>(content.size()); }

  void place(const std::string& content, const std::string& style, const Box& box) {
    taken_.push_back(box);
    const bool atEnd = style.starts_with("end");
    text(atEnd ? box.right : box.left, box.bottom - 3.5, style.c_str(), content);
  }

  double cost(const Box& box) const {
    const Box inside{kLeft, kTop, kWidth - kRight + 18, kHeight - kBottom};
    double sum = 4 * ((box.right - box.left) * (box.bottom - box.top) - box.overlap(inside));
    for (const Box& other : taken_) sum += box.overlap(other);
    return sum;
  }

  // The freest place beside one of the points; false where there is none with less overlap than `most`.
  bool placeBeside(const std::vector<LogPoint>& points, const std::string& content, const std::string& style,
                   double most) {
    constexpr double kBold = 1.25;  // bold letters are that much wider
    const double width = widthOf(content) * (style.find("bold") == std::string::npos ? 1 : kBold);
    double best = INFINITY;
    Box where{};
    for (size_t i = points.size(); i-- > 0;) {
      const double x = atX(points[i].x), y = atY(points[i]);
      for (const double far : {1.0, 2.0, 3.5}) {
        const double reach = kReach * far;
        const std::array<std::array<double, 2>, 8> corners{{{x + reach, y - 0.5 * kLineHeight},
                                                            {x - 0.5 * width, y - reach - kLineHeight},
                                                            {x - 0.5 * width, y + reach},
                                                            {x - reach - width, y - 0.5 * kLineHeight},
                                                            {x + reach, y - reach - kLineHeight},
                                                            {x + reach, y + reach},
                                                            {x - reach - width, y - reach - kLineHeight},
                                                            {x - reach - width, y + reach}}};
        for (const auto& [left, top] : corners) {
          const Box box{left, top, left + width, top + kLineHeight};
          const double price = cost(box) + 2 * far;
          if (price < best) {
            best = price;
            where = box;
          }
        }
      }
    }
    if (best > most) return false;
    place(content, style, where);
    return true;
  }

  void nameLine(const LogLine& line) {
    if (line.points.empty()) return;
    placeBeside(line.points, line.name, print("start bold t%d", line.colour), INFINITY);
  }

  void labelPoint(const LogLine& line, const LogPoint& point) {
    constexpr double kSmallOverlap = 24;
    if (!point.label.empty()) placeBeside({point}, point.label, print("start small t%d", line.colour), kSmallOverlap);
  }

  const LogChart& chart_;
  Range x_{}, y_{};
  double top_ = kTop;
  std::string svg_;
  std::vector<Box> taken_;
};

}  // namespace

std::string logChart(const LogChart& chart) {
  return Drawing(chart).draw();
}

}  // namespace radar::tools
