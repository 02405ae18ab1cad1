#include "report/chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <regex>
#include <set>

#include "report/axis.h"
#include "report/colours.h"
#include "report/gnuplot.h"
#include "report/labels.h"
#include "report/markup.h"
#include "report/print.h"

namespace radar::tools {

namespace {

constexpr double kLeft = 78, kBottom = 56, kTitle = 26, kAbout = 18;
constexpr double kSize = 14, kSmall = 12;
// The shares of misses that the band shows, from its lower edge up.
constexpr double kLeastMissed = 0.003, kMostMissed = 1;

std::string hex(const std::string& colour) {
  return "rgb '" + std::string(lightColour(colour)) + "'";
}
std::string hex(int colour) {
  return hex("c" + std::to_string(colour));
}

std::string sayingShare(double share) {
  return print("%g%%%%", 100 * share);  // gnuplot takes it as a format
}

int pointType(Mark mark, bool hollow) {
  constexpr std::array kFilled{7, 5, 9, 13};
  return kFilled[static_cast<size_t>(mark)] - (hollow ? 1 : 0);
}

// The script that draws a chart, without the choice of terminal. Places are pixels from the upper left corner.
class Script {
 public:
  explicit Script(const Chart& chart)
      : chart_(chart),
        top_(18 + (chart.title.empty() ? 0 : kTitle) + kAbout * static_cast<double>(chart.about.size())),
        places_({kLeft, top_, chart.width - 4, chart.height - kBottom}) {
    setAxes();
  }

  std::string write() {
    text_ = print("set encoding utf8\nset key off\nset border 0\nset tics scale 0 textcolor %s\n", hex("ink").c_str());
    text_ += print("set lmargin at screen %.6f\nset rmargin at screen %.6f\n", kLeft / chart_.width,
                   1 - right_ / chart_.width);
    text_ += print("set tmargin at screen %.6f\nset bmargin at screen %.6f\n", 1 - top_ / chart_.height,
                   kBottom / chart_.height);
    writeHeading();
    writeAxis("x", x_, "");
    writeAxis("y", y_, bandTics());
    writeNames();
    takeRoom();
    for (const ChartLine& line : chart_.lines) nameLine(line);
    for (const ChartLine& line : chart_.lines) {
      for (const ChartPoint& point : line.points) labelPoint(line, point);
    }
    nameFront();
    writePlots();
    return text_;
  }

 private:
  // The band's height grows with what is in it.
  void setAxes() {
    double least = INFINITY, most = 0, leastX = INFINITY, mostX = 0;
    size_t points = 0, wrong = 0;
    const auto take = [&](double y) {
      least = std::min(least, y);
      most = std::max(most, y);
    };
    if (chart_.floor > 0) take(chart_.floor);
    for (const ChartLine& line : chart_.lines) {
      for (const ChartPoint& point : line.points) {
        leastX = std::min(leastX, point.x);
        mostX = std::max(mostX, point.x);
        ++points;
        if (point.missed > 0) {
          ++wrong;
        } else {
          take(std::max(point.y, chart_.floor));
        }
      }
    }
    if (!chart_.logarithmic) {
      x_ = linearAxis(mostX);
      y_ = linearAxis(most);
    } else {
      x_ = points > 0 ? logAxis(leastX, mostX) : logAxis(1, 10);
      y_ = most > 0 ? logAxis(least, std::max(most, (chart_.floor > 0 ? 1e4 : 2) * least)) : logAxis(0.1, 1);
    }
    const double share = points > 0 ? static_cast<double>(wrong) / static_cast<double>(points) : 0;
    band_ = chart_.missedName.empty() ? 0 : 90 + 130 * share;
    // Names of lines across the chart stand at their ends.
    if (!chart_.missedName.empty()) return;
    for (const ChartLine& line : chart_.lines) right_ = std::max(right_, 20 + widthOf(line.name, kSize, true));
    ticAtPoints();
  }

  // Few places, powers of two perhaps: they say more than round numbers.
  void ticAtPoints() {
    constexpr size_t kMost = 8;
    std::set<double> places;
    for (const ChartLine& line : chart_.lines) {
      for (const ChartPoint& point : line.points) places.insert(point.x);
    }
    if (places.size() > 1 && places.size() <= kMost) x_.tics.assign(places.begin(), places.end());
  }

  double bottom() const { return chart_.height - kBottom; }
  double xOf(const ChartPoint& point) const { return kLeft + (chart_.width - kLeft - right_) * x_.share(point.x); }
  double yOf(const ChartPoint& point) const {
    if (point.missed > 0) {
      const double share = std::clamp(point.missed, kLeastMissed, kMostMissed);
      return top_ + band_ - 12 - (band_ - 40) * std::log(share / kLeastMissed) / std::log(kMostMissed / kLeastMissed);
    }
    return bottom() - (bottom() - top_ - band_) * y_.share(std::max(point.y, chart_.floor));
  }
  Spot spotOf(const ChartPoint& point) const { return {xOf(point), yOf(point)}; }
  // The value of the y axis at a height, in the band too: gnuplot's axis goes on through it.
  double valueAt(double y) const { return y_.valueAt((bottom() - y) / (bottom() - top_ - band_)); }
  std::string dataOf(const ChartPoint& point) const { return print("%.9g %.9g\n", point.x, valueAt(yOf(point))); }

  void label(double x, double y, const std::string& content, const std::string& style) {
    text_ += "set label " + quoted(content) +
             print(" at screen %.6f,%.6f noenhanced ", x / chart_.width, 1 - y / chart_.height) + style + "\n";
  }
  static std::string font(double size, bool bold) {
    return print("font 'sans-serif%s,%.0f'", bold ? " bold" : "", size);
  }
  static std::string soft() { return "textcolor " + hex("soft"); }

  void writeHeading() {
    double y = 20;
    if (!chart_.title.empty()) {
      label(kLeft, y, chart_.title, font(kSize + 2, true) + " textcolor " + hex("ink"));
      y += kTitle - 4;
    }
    for (const std::string& line : chart_.about) {
      label(kLeft, y, line, font(kSmall, false) + " " + soft());
      y += kAbout;
    }
  }

  void writeAxis(const char* name, const Axis& axis, const std::string& more) {
    const bool isY = *name == 'y';
    if (axis.logarithmic) text_ += print("set logscale %s\n", name);
    text_ += print("set %srange [%.9g:%.9g]\n", name, axis.low, isY ? valueAt(top_) : axis.high);
    text_ += print("set %stics (", name);
    for (const double tic : axis.tics) text_ += quoted(inTic(tic)) + print(" %.9g, ", tic);
    if (axis.tics.empty() && more.empty()) text_ += "'' 1, ";
    text_ += more;
    text_.resize(text_.size() - 2);
    text_ +=
        print(") %s\nset grid %stics lt 1 lw 1 lc %s\n", font(kSize - 1, false).c_str(), name, hex("grid").c_str());
  }

  std::string bandTics() const {
    if (chart_.missedName.empty()) return "";
    std::string tics;
    for (const double share : {0.01, 0.1, 1.0}) {
      tics += quoted(sayingShare(share)) + print(" %.9g, ", valueAt(yOf({.missed = share})));
    }
    return tics;
  }

  void writeNames() {
    const std::string ink = font(kSize, false) + " center textcolor " + hex("ink");
    label(0.5 * (kLeft + chart_.width - right_), chart_.height - 14, chart_.xName, ink);
    label(14, 0.5 * (top_ + band_ + bottom()), chart_.yName, ink + " rotate by 90");
    if (chart_.floor > 0) {
      const double y = yOf({.y = chart_.floor}), right = chart_.width - right_;
      text_ += print("set arrow from graph 0, first %.9g to graph 1, first %.9g nohead dt 2 lw 1.5 lc %s back\n",
                     valueAt(y), valueAt(y), hex("soft").c_str());
      label(right - 4, y - 14, chart_.floorName, font(kSize - 1, false) + " right " + soft());
      places_.take({right - 4 - widthOf(chart_.floorName, kSize - 1, false), y - 22, right, y - 4});
    }
    if (chart_.missedName.empty()) return;
    text_ += print(
        "set object rectangle from graph 0, first %.9g to graph 1,1 fc %s fs transparent solid 0.1 noborder "
        "behind\n",
        valueAt(top_ + band_), hex(1).c_str());
    label(kLeft + 6, top_ + 11, chart_.missedName, font(kSize - 1, false) + " left " + soft());
    places_.take({kLeft, top_, kLeft + 6 + widthOf(chart_.missedName, kSize - 1, false), top_ + 19});
  }

  // What labels had better not stand on.
  void takeRoom() {
    constexpr double kHalf = 6;
    for (const ChartLine& line : chart_.lines) {
      for (size_t i = 0; i < line.points.size(); ++i) {
        const Spot at = spotOf(line.points[i]);
        if (!line.dashed) places_.take({at.x - kHalf, at.y - kHalf, at.x + kHalf, at.y + kHalf});
        if (i + 1 < line.points.size()) places_.takeLine(at, spotOf(line.points[i + 1]));
      }
    }
    if (chart_.floor > 0) {
      const double y = yOf({.y = chart_.floor});
      places_.takeLine({kLeft, y}, {chart_.width - right_, y});
    }
    if (chart_.front.empty()) return;
    Spot at{xOf(chart_.front[0]), top_};
    for (const ChartPoint& point : chart_.front) {
      const Spot next = spotOf(point);
      places_.takeLine(at, {next.x, at.y});
      places_.takeLine({next.x, at.y}, next);
      at = next;
    }
    places_.takeLine(at, {chart_.width - right_, at.y});
  }

  static double widthOf(const std::string& content, double size, bool bold) {
    return (bold ? 0.63 : 0.56) * size * static_cast<double>(content.size());
  }

  bool placeLabel(const std::vector<ChartPoint>& points, const std::string& content, double size, bool bold,
                  const std::string& colour, double most) {
    std::vector<Spot> spots;
    spots.reserve(points.size());
    for (const ChartPoint& point : points) spots.push_back(spotOf(point));
    const auto place = places_.placeBeside(spots, widthOf(content, size, bold), size + 3, most);
    if (!place) return false;
    // Letters may be narrower than thought: they stand at the side of the spot.
    const Box& box = place->box;
    const bool after = box.left >= place->spot.x, before = box.right <= place->spot.x;
    label(after    ? box.left
          : before ? box.right
                   : 0.5 * (box.left + box.right),
          0.5 * (box.top + box.bottom), content,
          font(size, bold) +
              (after    ? " left"
               : before ? " right"
                        : " center") +
              " textcolor " + colour);
    return true;
  }

  // At its end, if there is room.
  void nameLine(const ChartLine& line) {
    if (line.points.empty()) return;
    constexpr double kSmallOverlap = 150;
    if (placeLabel({line.points.back()}, line.name, kSize, true, hex(line.colour), kSmallOverlap)) return;
    placeLabel(line.points, line.name, kSize, true, hex(line.colour), INFINITY);
  }
  void labelPoint(const ChartLine& line, const ChartPoint& point) {
    constexpr double kSmallOverlap = 25;  // of square pixels, and of what distance costs
    if (!point.label.empty()) placeLabel({point}, point.label, kSmall, false, hex(line.colour), kSmallOverlap);
  }
  void nameFront() {
    if (chart_.front.empty()) return;
    ChartPoint along = chart_.front.back();
    along.x = x_.valueAt(0.6);
    placeLabel({along}, chart_.frontName, kSmall, false, hex("soft"), INFINITY);
  }

  void add(const std::string& style, const std::string& data) {
    plots_ += (plots_.empty() ? "plot '-' " : ", \\\n  '-' ") + style;
    data_ += data + "e\n";
  }

  void writePlots() {
    if (!chart_.front.empty()) {
      std::string data = print("%.9g %.9g\n", chart_.front[0].x, valueAt(top_));
      for (const ChartPoint& point : chart_.front) data += dataOf(point);
      data += print("%.9g %.9g\n", x_.high, valueAt(yOf(chart_.front.back())));
      add("with steps notitle lt 1 lw 7 lc rgb '#b0" + std::string(lightColour("soft")).substr(1) + "'", data);
    }
    for (const ChartLine& line : chart_.lines) addLine(line);
    for (const ChartLine& line : chart_.lines) {
      for (const ChartPoint& point : line.points) {
        if (!line.dashed) addMark(line, point);
      }
    }
    // gnuplot wants something to plot.
    if (plots_.empty()) add("with points notitle pt 0", print("%.9g %.9g\n", x_.low, y_.low));
    text_ += plots_ + "\n" + data_;
  }

  void addLine(const ChartLine& line) {
    if (line.points.size() < 2) return;
    std::string data;
    for (const ChartPoint& point : line.points) data += dataOf(point);
    add(line.dashed ? "with lines notitle dt 2 lw 1.5 lc " + hex("soft")
                    : "with lines notitle lt 1 lw 1.7 lc " + hex(line.colour),
        data);
  }

  // A plot of its own, because a plot's title shows when pointed at.
  void addMark(const ChartLine& line, const ChartPoint& point) {
    const std::string title = point.tip.empty() ? " notitle" : " title " + quoted(point.tip) + " noenhanced";
    const auto mark = [&](int type, double size, double width, const std::string& colour, const std::string& tip) {
      add(print("with points pt %d ps %.2f lw %.1f lc ", type, size, width) + colour + tip, dataOf(point));
    };
    constexpr double kMark = 1.1, kLine = 1.8;
    if (point.missed > 0) {
      mark(2, kMark, 2.4, hex(line.colour), title);
    } else if (line.hollow) {
      mark(pointType(line.mark, false), kMark, kLine, hex("panel"), " notitle");
      mark(pointType(line.mark, true), kMark, kLine, hex(line.colour), title);
    } else {
      mark(pointType(line.mark, false), kMark, kLine, hex(line.colour), title);
    }
  }

  const Chart& chart_;
  double top_, right_ = 30, band_ = 0;
  Axis x_, y_;
  LabelPlaces places_;
  std::string text_, plots_, data_;
};

std::string terminal(const Chart& chart, const char* type, double scale) {
  return print("set terminal %s size %.0f,%.0f font 'sans-serif,%.0f' background '%s'", type, scale * chart.width,
               scale * chart.height, kSize, std::string(lightColour("panel")).c_str());
}

std::string bodyOf(const Chart& chart) {
  const std::string svg = gnuplot(terminal(chart, "svg", 1) + "\n" + Script(chart).write());
  return svg.substr(std::min(svg.find("<g id=\"gnuplot_canvas\""), svg.size()));
}

std::string viewBox(const Chart& chart) {
  return print("viewBox=\"0 0 %.0f %.0f\"", chart.width, chart.height);
}

}  // namespace

std::string inlineSvg(const Chart& chart, const std::string& id) {
  return openSvg(viewBox(chart), chart.title) +
         std::regex_replace(bodyOf(chart), std::regex(R"((\bid=['"]|href='#))"), "$1" + id + "-");
}

std::string svgFile(const Chart& chart) {
  return openSvg("xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" " +
                     print("width=\"%.0f\" height=\"%.0f\" ", chart.width, chart.height) + viewBox(chart),
                 chart.title) +
         "<style>" + darkChartRules() + "</style>\n" + bodyOf(chart);
}

std::string pngFile(const Chart& chart) {
  return gnuplot(terminal(chart, "pngcairo", 2) + " fontscale 1.5 linewidth 2 pointscale 3.3\n" +
                 Script(chart).write());
}

}  // namespace radar::tools
