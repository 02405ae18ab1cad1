// Charts as gnuplot draws them.
#include <filesystem>

#include "chart/charts.h"
#include "plot/plot.h"
#include "support/catch.h"
#include "support/scratch_folder.h"

using namespace radar;
using namespace radar::tools;
using test::Contains;

namespace {

const char* const kHeader = "chart,name,linetype,size,x,us,wrong_percent,worst_error\n";

Cell cellOf(const char* section, const std::string& workload, const std::string& family, uint32_t size, double x) {
  Cell cell;
  cell.section = section;
  cell.workload = workload;
  cell.family = family;
  cell.size = size;
  cell.method = size == 0 ? family : family + " " + std::to_string(size);
  cell.x = x;
  cell.us = 10 + x + size;
  cell.queries = 10;
  cell.errorWorst = 1e-3;
  return cell;
}

// Two methods of ours and one of another library in every section; the first sizes miss contacts.
Record smallRecord() {
  Record record;
  record.add("workload", "thin: Thin shapes: sheets and rods");
  for (const uint32_t size : {16, 64}) {
    for (const char* family : {"sampled", "Embree rays"}) {
      record.cells.push_back(cellOf("front", "thin", family, size, 0));
      record.cells.back().misses = size == 16 ? 3 : 0;
    }
  }
  record.cells.push_back(cellOf("front", "thin", "contact", 0, 0));
  for (const double x : {1'000, 30'000}) {
    for (const char* family : {"sampled", "contact", "FCL steps"}) {
      record.cells.push_back(cellOf("table1", "boxes", family, 0, x));
      for (const char* axis : {"boxes", "sensors", "triangles"}) {
        record.cells.push_back(cellOf("growth", axis, family, 0, x));
      }
    }
  }
  return record;
}

bool isSvg(const std::string& text) {
  return text.starts_with("<?xml") && text.ends_with("</svg>\n\n") && text.find("nan") == std::string::npos;
}

}  // namespace

TEST_CASE("every chart of a record is drawn with its title, the name of each of its methods, and where it is from") {
  const test::ScratchFolder folder;
  Record record = smallRecord();
  record.add("device", "some device");
  record.add("machine", "a processor");
  record.add("commit", "1234567");
  writeCharts(folder.path(), record);
  const auto shows = [&](const std::string& file, const std::vector<std::string>& texts) {
    const std::string svg = folder.read(file);
    CAPTURE(file);
    CHECK(isSvg(svg));
    CHECK_THAT(svg, Contains("<text>some device; a processor; commit 1234567</text>"));
    for (const std::string& text : texts) CHECK_THAT(svg, Contains("<text>" + text + "</text>"));
  };
  shows("front-thin.svg", {"Thin shapes", "sheets and rods", "sampled", "contact", "Embree rays", "on the front",
                           "wrong answers, % of queries", "worst error, in sensor sizes"});
  shows("table1.svg", {"sampled", "contact", "FCL steps", "the paper's OPCODE", "microseconds per query", "30k"});
  shows("growth-boxes.svg", {"sampled", "contact", "FCL steps", "boxes", "1000"});
  shows("growth-sensors.svg", {"FCL steps", "sensors in the batch"});
  shows("growth-triangles.svg", {"FCL steps", "triangles of each mesh"});
  shows("growth-resolution.svg", {"Time against resolution", "sampled", "Embree rays", "64"});
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 6 + 4);  // the points and three tables
  CHECK_THAT(folder.read("front-thin.svg"), Contains("Other libraries (hollow)"));
  CHECK_THAT(folder.read("table1.svg"), Contains("hollow: other libraries"));
}

TEST_CASE("a chart without other libraries has none in its legend") {
  const test::ScratchFolder folder;
  Record record = smallRecord();
  std::erase_if(record.cells, [](const Cell& cell) { return cell.family.find(' ') != std::string::npos; });
  writeCharts(folder.path(), record);
  for (const char* file : {"front-thin.svg", "table1.svg", "growth-resolution.svg"}) {
    CAPTURE(file);
    CHECK(isSvg(folder.read(file)));
    CHECK_THAT(folder.read(file), Contains("sampled") && !Contains("ther libraries"));
  }
}

TEST_CASE("the points have the front by rising time, and a family's linetype is the same in every chart") {
  const test::ScratchFolder folder;
  Record record = smallRecord();
  record.cells[0].us = 1;  // sampled 16, which misses contacts
  writeCharts(folder.path(), record);
  const std::string points = folder.read("points.csv");
  CHECK_THAT(points, test::StartsWith(kHeader));
  CHECK_THAT(points, Contains("front-thin,front,21,16,,1,30,0.001\nfront-thin,front,21,0,,10,0,0.001\n"));
  CHECK_THAT(points, Contains("front-thin,Embree rays,6,") && Contains("growth-boxes,FCL steps,7,"));
  CHECK_THAT(points, Contains("table1,contact,3,") && Contains("front-thin,contact,3,"));
}

TEST_CASE("titles, names and paths are text: gnuplot runs none of it") {
  const test::ScratchFolder folder;
  const std::string hostile =
      "it's `touch hacked` $(touch hacked) $x {/:Bold \\n} %s_^@~ #', system('touch hacked') \"";
  Record record = smallRecord();
  record.head = {"workload: thin: " + hostile};
  for (Cell& cell : record.cells) {
    if (cell.family == "Embree rays") cell.family = "it's `touch hacked` $(x) {/:Bold} #\nset output 'hacked'";
  }
  writeCharts(folder.path(), record);
  CHECK_THAT(folder.read("front-thin.svg"), Contains("<text>" + hostile + "</text>"));
  CHECK_THAT(folder.read("front-thin.svg"),
             Contains("<text>it's `touch hacked` $(x) {/:Bold} # set output 'hacked'</text>"));
  // A name that gnuplot would run as a command.
  std::filesystem::create_directory(folder.path() / "< touch hacked");
  writeCharts(folder.path() / "< touch hacked", smallRecord());
  CHECK_THAT(folder.read("< touch hacked/table1.svg"), Contains("FCL steps"));
  CHECK_FALSE(std::filesystem::exists(folder.path() / "hacked"));
  CHECK_FALSE(std::filesystem::exists("hacked"));
}

TEST_CASE("a front is drawn of one point, of wrong answers only, of none, and of extreme numbers") {
  const test::ScratchFolder folder;
  for (const char* rows : {"c,a,3,0,,5,0,1e-13\nc,front,21,0,,5,0,1e-13\n",
                           "c,a,1,16,,5,100,1\nc,front,21,16,,5,100,1\n", "c,a,3,0,,5,0,1e-13\nc,a,3,0,,5,0,1e-13\n",
                           "c,a,1,16,,1e-9,0.0001,1\nc,a,1,1024,,1e12,0,1e200\nc,front,21,16,,1e-9,0.0001,1\n"}) {
    CAPTURE(rows);
    folder.write("points.csv", std::string(kHeader) + rows);
    CHECK(isSvg(plot(kFrontScript, folder.path() / "points.csv", {"c", "title", ""})));
  }
  Record unmeasured;
  unmeasured.add("workload", "w: Not measured");
  writeCharts(folder.path(), unmeasured);
  CHECK_FALSE(std::filesystem::exists(folder.path() / "front-w.svg"));
}

TEST_CASE("a script that fails, or has nothing to draw, is an error") {
  const test::ScratchFolder folder;
  folder.write("points.csv", kHeader);
  CHECK_THROWS_WITH(plot("set nonsense\n", folder.path() / "points.csv", {}), Contains("gnuplot"));
  CHECK_THROWS_WITH(plot(kFrontScript, folder.path() / "points.csv", {"c", "t", ""}), Contains("gnuplot"));
  CHECK_THROWS_WITH(plot(kScaleScript, folder.path() / "missing.csv", {"t"}), Contains("gnuplot"));
}
