// Charts as gnuplot draws them, and where their labels go.
#include <catch2/catch.hpp>
#include <regex>

#include "report/axis.h"
#include "report/chart.h"
#include "report/colours.h"
#include "report/gnuplot.h"
#include "report/labels.h"

using namespace radar::tools;
using Catch::Matchers::Contains;

namespace {

size_t count(const std::string& text, const std::string& what) {
  size_t number = 0;
  for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++number;
  return number;
}

ChartLine lineOf(const std::string& name, std::vector<ChartPoint> points) {
  ChartLine line;
  line.name = name;
  line.points = std::move(points);
  return line;
}

Chart frontChart() {
  Chart chart;
  chart.title = "Shapes & <more>";
  chart.about = {"some of them"};
  chart.xName = "time";
  chart.yName = "error";
  chart.floor = 1e-13;
  chart.floorName = "nothing";
  chart.missedName = "misses";
  chart.lines = {lineOf("sampled", {{10, 0.5, 0.2, "16", "one in five"}, {100, 1e-3, 0, "64", "none"}}),
                 lineOf("contact", {{50, 0, 0, "", "exact"}})};
  chart.front = {chart.lines[0].points[0], chart.lines[1].points[0]};
  chart.frontName = "front";
  return chart;
}

}  // namespace

TEST_CASE("a chart shows its names, labels and tips, misses as crosses, and the same bytes every time") {
  const Chart chart = frontChart();
  const std::string svg = svgFile(chart);
  for (const char* text :
       {"Shapes &amp; &lt;more", ">some of them<", ">time<", ">error<", ">nothing<", ">misses<", ">sampled<",
        ">contact<", ">16<", ">64<", ">front<", "<title>one in five</title>", "<title>exact</title>"}) {
    CHECK_THAT(svg, Contains(text));
  }
  // Of the three points one is crossed; gnuplot draws marks by reference.
  CHECK(count(svg, "<use xlink:href='#gpPt1' transform") == 1);
  CHECK(count(svg, "<use xlink:href='#gpPt6' transform") == 2);
  CHECK(svg == svgFile(chart));
  CHECK(pngFile(chart) == pngFile(chart));
  CHECK_THAT(pngFile(chart), Catch::StartsWith("\x89PNG"));
}

TEST_CASE("every colour that gnuplot writes has a dark one, so that no chart stays light on a dark screen") {
  Chart chart = frontChart();
  chart.lines[1].hollow = true;
  chart.lines.push_back(lineOf("paper", {{10, 1, 0, "", ""}, {20, 2, 0, "", ""}}));
  chart.lines.back().dashed = true;
  const std::string svg = inlineSvg(chart, "c"), rules = darkChartRules();
  const std::regex colour(R"re((fill|stroke|color) ?= ?['"](rgb\([^)]*\)|#[0-9a-fA-F]{6})['"])re");
  size_t found = 0;
  for (std::sregex_iterator match(svg.begin(), svg.end(), colour), end; match != end; ++match, ++found) {
    // What gnuplot sets up for lines it then does not draw, in capitals, is not seen.
    if (std::regex_search((*match)[2].str(), std::regex("#.*[A-F]"))) continue;
    CHECK_THAT(rules, Contains("[" + (*match)[1].str() + "=\"" + (*match)[2].str() + "\"]"));
  }
  CHECK(found > 20);
}

TEST_CASE("charts of one page keep their names inside apart and load nothing") {
  const std::string svg = inlineSvg(frontChart(), "first");
  CHECK_THAT(svg, Catch::StartsWith("<svg ") && Contains("id='first-gpPt6'") && Contains("'#first-gpPt6'"));
  CHECK(count(svg, "'#gp") == 0);
  CHECK_THAT(svg, !Contains("http") && !Contains("<script"));
}

TEST_CASE("names of any kind are text and nothing else") {
  Chart chart = frontChart();
  const std::string name = "it's `touch hacked` \"$(touch hacked)\" {/:Bold \\n} %s_^@~";
  chart.title = chart.lines[0].name = chart.lines[0].points[0].tip = name;
  const std::string svg = svgFile(chart);
  CHECK(count(std::regex_replace(svg, std::regex("&quot;"), "\""), name) == 5);  // twice as title, drawn, name, tip
  chart.lines[0].name = "two\nset output 'hacked'\nlines";
  CHECK_THAT(svgFile(chart), Contains("two set output 'hacked' lines"));
}

TEST_CASE("a chart survives flat lines, one point, none, zero, and all of it missed") {
  for (const bool logarithmic : {true, false}) {
    Chart chart = frontChart();
    chart.logarithmic = logarithmic;
    chart.floor = 0;
    chart.front.clear();
    const double zero = logarithmic ? 1e-300 : 0;
    for (const std::vector<ChartPoint>& points : {std::vector<ChartPoint>{},
                                                  {{5, zero, 0, "", ""}},
                                                  {{5, 3, 0, "", ""}, {10, 3, 0, "", ""}},
                                                  {{5, 3, 1, "", ""}},
                                                  {{1e-9, 1e-9, 0, "", ""}, {1e12, 1e12, 0, "", ""}}}) {
      chart.lines = {lineOf("a", points), lineOf("b", points)};
      CHECK_THAT(svgFile(chart), Contains("</svg>") && !Contains("nan") && !Contains("inf"));
    }
  }
}

TEST_CASE("a script that gnuplot does not take is an error") {
  CHECK_THROWS_WITH(gnuplot("set nonsense\n"), Contains("gnuplot"));
}

TEST_CASE("axes reach around their values, with tics that read well") {
  const Axis log = logAxis(13, 7'000);
  CHECK(log.low < 13);
  CHECK(log.high > 7'000);
  CHECK(log.tics == std::vector<double>{100, 1'000});
  CHECK(log.valueAt(log.share(500)) == Approx(500));
  CHECK(linearAxis(23).tics == std::vector<double>{0, 5, 10, 15, 20, 25});
  CHECK(inTic(0.05) == "0.05");
  CHECK(inTic(0) == "0");
  CHECK(inTic(1e-7) == "1e-7");
  CHECK(inTic(0.0005) == "0.0005");
  CHECK(inTic(2.5e9) == "2.5e+09");
  CHECK(inTic(1'234'567) == "1,234,567");
}

TEST_CASE("labels stand beside their spot, apart from each other, or not at all") {
  LabelPlaces places({0, 0, 200, 100});
  std::vector<Box> boxes;
  for (int i = 0; i < 4; ++i) {
    const auto place = places.placeBeside({{100, 50}}, 60, 16, 1);
    if (place) boxes.push_back(place->box);
  }
  REQUIRE(boxes.size() >= 2);
  for (size_t i = 0; i < boxes.size(); ++i) {
    for (size_t k = 0; k < i; ++k) {
      const Box &a = boxes[i], &b = boxes[k];
      CHECK((a.left >= b.right || b.left >= a.right || a.top >= b.bottom || b.top >= a.bottom));
    }
  }
  places.take({0, 0, 200, 100});
  CHECK_FALSE(places.placeBeside({{100, 50}}, 60, 16, 1).has_value());
}
