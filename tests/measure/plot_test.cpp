// Charts as gnuplot draws them.
#include "measure/plot.h"

#include <cmath>
#include <filesystem>
#include <set>

#include "support/catch.h"
#include "support/scratch_folder.h"

using namespace radar::tools;
using radar::test::Contains;
using radar::test::ScratchFolder;

namespace {

Json pointOf(const std::string& name, int linetype, double us, double wrong, double error) {
  return {{"name", name}, {"linetype", linetype},   {"size", 16},
          {"us", us},     {"wrong_percent", wrong}, {"worst_error", error}};
}

// The marks of a whole picture: those of points, and others that do not depend on them.
size_t marksOf(const std::string& svg) {
  REQUIRE((svg.starts_with("<?xml") && svg.ends_with("</svg>\n\n") && svg.find("nan") == std::string::npos));
  size_t marks = 0;
  for (size_t at = 0; (at = svg.find("<use xlink:href='#gpPt", at)) != std::string::npos; ++at) ++marks;
  return marks;
}

}  // namespace

TEST_CASE("lines are drawn in a panel for each column, with every name in the key") {
  Json rows = Json::array();
  for (const double x : {5.0, 10.0}) {
    rows.push_back({{"name", "0"}, {"linetype", 1}, {"x", x}, {"ms", x}, {"speed_up", 1}});
    rows.push_back({{"name", "0+1"}, {"linetype", 3}, {"x", x}, {"ms", x / 2}, {"speed_up", 2}});
  }
  const std::string svg =
      plot(kLinesScript, rows, {"Title", "origin", "sensors", "devices", "milliseconds", "speed-up"});
  rows.erase(3);
  CHECK(marksOf(svg) == marksOf(plot(kLinesScript, rows, {"", "", "", "", "", ""})) + 2);
  for (const char* text : {"Title", "origin", "sensors", "devices", "milliseconds", "speed-up", "0", "0+1"}) {
    CHECK_THAT(svg, Contains(std::string("<text>") + text + "</text>"));
  }
}

TEST_CASE("titles and names are text: gnuplot runs none of it") {
  const std::string hostile =
      "it's `touch hacked` $(touch hacked) $x {/:Bold \\n} %s_^@~ #', system('touch hacked') \"";
  const std::string svg =
      plot(kFrontScript, Json::array({pointOf("it's `touch hacked` $(x) {/:Bold} #\nset output 'hacked'", 6, 1, 0, 1)}),
           {hostile, hostile});
  CHECK_THAT(svg, Contains("<text>" + hostile + "</text>"));
  CHECK_THAT(svg, Contains("<text>it's `touch hacked` $(x) {/:Bold} # set output 'hacked'</text>"));
  CHECK_FALSE(std::filesystem::exists("hacked"));
}

TEST_CASE("a front is drawn of one point, of wrong answers only, and of extreme numbers") {
  const std::vector<std::vector<Json>> fronts{
      {pointOf("a", 3, 5, 0, 1e-13), pointOf("front", 21, 5, 0, 1e-13)},
      {pointOf("a", 1, 5, 100, 1), pointOf("front", 21, 5, 100, 1)},
      {pointOf("a", 3, 5, 0, 1e-13), pointOf("a", 3, 5, 0, 1e-13)},
      {pointOf("a", 1, 1e-9, 0.0001, 1), pointOf("a", 1, 1e12, 0, 1e200), pointOf("front", 21, 1e-9, 0.0001, 1)}};
  std::set<size_t> marks;
  for (const std::vector<Json>& rows : fronts) {
    CAPTURE(Json(rows).dump());
    const std::string svg = plot(kFrontScript, rows, {"title", ""});
    marks.insert(marksOf(svg) - rows.size());
    CHECK_THAT(svg, Contains("<text>a</text>") && Contains("<text>on the front</text>"));
  }
  CHECK(marks.size() == 1);  // whatever the points, each has its mark
}

TEST_CASE("a script that fails, or has nothing to draw, is an error") {
  CHECK_THROWS_WITH(plot("set nonsense\n", Json::array({pointOf("a", 1, 1, 1, 1)}), {}), Contains("gnuplot"));
  CHECK_THROWS_WITH(plot(kFrontScript, Json::array(), {"t", ""}), Contains("gnuplot"));
  CHECK_THROWS_WITH(plot(kLinesScript, Json::array(), {"t"}), Contains("gnuplot"));
}
