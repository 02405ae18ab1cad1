#include "measure/chart.h"

#include <algorithm>
#include <filesystem>

#include "support/answer.h"
#include "support/catch.h"
#include "support/scratch_folder.h"

using namespace radar;
using namespace radar::tools;
using test::Contains;

namespace {

/// A cell of made-up numbers: 10 queries, each with a contact.
Cell madeUp(const std::string& method, double us, double worst, uint32_t misses = 0) {
  Cell cell;
  cell.section = "front";
  cell.workload = "w";
  cell.method = cell.family = method;
  cell.queries = cell.contacts = 10;
  cell.us = us;
  cell.errorWorst = worst;
  cell.misses = misses;
  cell.found = 10 - misses;
  return cell;
}

std::vector<std::string> namesOn(const std::vector<Cell>& cells) {
  std::vector<const Cell*> all(cells.size());
  std::ranges::transform(cells, all.begin(), [](const Cell& cell) { return &cell; });
  std::vector<std::string> names;
  for (const Cell* cell : frontOf(all)) names.push_back(cell->method);
  return names;
}

Result truthAt(double t) {
  Result result;
  result.status = std::isnan(t) ? Status::clear : Status::hit;
  result.t = result.lo = result.hi = t;
  return result;
}

// The sums of made-up cells, whose workloads are those of `fronts`.
Json summed(const std::vector<Cell>& cells, const std::vector<std::string>& fronts, const test::ScratchFolder& folder) {
  Json report = newReport("", {{"device", "some device"}}), rows = Json::array(), cases = Json::array();
  for (const Cell& cell : cells) rows.push_back(rowOf(cell));
  for (const std::string& workload : fronts) {
    cases.push_back({{"section", "front"}, {"workload", workload}, {"about", workload + ": About"}, {"axis", ""}});
  }
  setRows(report, "cases", "", cases);
  setRows(report, "front", "", rows);
  sumUp(report, folder.path());
  return report;
}

}  // namespace

TEST_CASE("the front holds what nothing beats in both speed and accuracy, and a miss outweighs any error") {
  CHECK(namesOn({madeUp("slow", 9, 0.1), madeUp("exact", 5, 0), madeUp("rough", 2, 0.5), madeUp("rougher", 3, 0.6),
                 madeUp("blind", 1, 1e-9, 3), madeUp("blinder", 1.5, 0, 4)}) ==
        std::vector<std::string>{"blind", "rough", "exact"});
  CHECK(namesOn({madeUp("a", 2, 1e-15), madeUp("b", 1, 1e-14)}) == std::vector<std::string>{"b"});
  CHECK(namesOn({}).empty());
}

TEST_CASE("of one method's rows the fastest number of threads is shown, and none that failed") {
  std::vector<Cell> cells{madeUp("m", 4, 0), madeUp("m", 3, 0), madeUp("broken", NAN, NAN)};
  cells[1].threads = 2;
  cells[2].failed = "crashes: Segmentation fault";
  const std::vector<const Cell*> shown = shownCells(cells, "w");
  REQUIRE(shown.size() == 1);
  CHECK(shown[0]->threads == 2);
}

TEST_CASE("answers are judged against the truth: errors, misses, inventions and broken promises") {
  Truth truth;
  truth.answers = {truthAt(2), truthAt(2), truthAt(NAN), truthAt(4), truthAt(4), truthAt(2)};
  truth.sizes.assign(6, 2);
  const std::vector<Result> answers{
      test::madeUpAnswer(Status::hit, 2.5, 1.5, 2.5),     truthAt(NAN),
      test::madeUpAnswer(Status::hit, 1, 0, 1),           test::madeUpAnswer(Status::hit, 3, 3, 4),
      test::madeUpAnswer(Status::undecided, NAN, 0, NAN), test::madeUpAnswer(Status::hit, 2.5, 2.25, 2.75)};
  Cell cell;
  cell.queries = 6;
  static_cast<Accuracy&>(cell) = accuracyOf(answers, truth, true);
  CHECK(cell.contacts == 5);
  CHECK(cell.found == 3);
  CHECK(cell.misses == 2);
  CHECK(cell.falseHits == 1);
  CHECK(cell.violations == 3);  // the certain "none", the invented contact, the lower bound beyond t*
  CHECK(cell.errorMedian == 0.25);
  CHECK(cell.errorWorst == 0.5);
  CHECK(cell.widthWorst == 0.5);
  CHECK(cell.wrongShare() == 0.5);
}

TEST_CASE("the tables sum up every method over all workloads, and tell where it fails") {
  std::vector<Cell> cells{madeUp("contact", 2, 0), madeUp("FCL steps", 4, 0), madeUp("FCL steps", 9, 0.1, 1),
                          madeUp("contact", 5, 0), madeUp("ODE steps", 1, 0, 3)};
  cells[1].size = 16;
  cells[1].method = "FCL steps 16";
  cells[2].size = 64;
  cells[2].method = "FCL steps 64";
  for (size_t i = 3; i < cells.size(); ++i) cells[i].workload = "v";
  cells.push_back(madeUp("contact", NAN, NAN));
  cells.back().workload = "none";
  cells.back().failed = "crashes";
  const test::ScratchFolder folder;
  summed(cells, {"w", "v", "none"}, folder);
  CHECK(folder.read("methods.csv") ==
        "method,wrong_percent,on_worst_workload,worst_error,us_least,us_most,fails_on\n"
        "contact,0,0,0,2,5,none\nFCL steps 16,0,0,0,4,4,v none\nFCL steps 64,10,10,0.1,9,9,v none\n"
        "ODE steps,30,30,0,1,1,w none\n");
  CHECK(folder.read("workloads.csv") ==
        "workload,queries,contacts,contact,contact on device,reference,sampled 64,fastest_other_always_right,us\n"
        "w,10,10,2,,,,FCL steps 16,4\nv,10,10,5,,,,none,\n");
  CHECK_FALSE(std::filesystem::exists(folder.path() / "front-none.svg"));
}

TEST_CASE("growing work is described from its first row to its last, beside the paper's times of Table 1") {
  const test::ScratchFolder folder;
  Json report = newReport(""), rows = Json::array();
  for (const double boxes : {10'000.0, 20'000.0, 30'000.0}) {
    for (const char* method : {"contact", "FCL steps"}) {
      Cell cell = madeUp(method, method == std::string("contact") ? 4 : boxes / 5'000, 0);
      cell.section = cell.workload = "table1";
      cell.x = boxes;
      rows.push_back(rowOf(cell));
    }
  }
  setRows(report, "cases", "",
          {{{"section", "table1"}, {"workload", "table1"}, {"about", "Table 1: teapots"}, {"axis", "boxes"}}});
  setRows(report, "table1", "", rows);
  sumUp(report, folder.path());
  const std::string csv = folder.read("growth.csv");
  CHECK_THAT(csv, Contains("\ntable1,contact,10000,4,30000,4,1\ntable1,FCL steps,10000,2,30000,6,3\n"));
  CHECK_THAT(csv, Contains("\ntable1,the paper's OPCODE,10000,11270,30000,85480,7.58"));
  for (const char* text : {"Table 1", "teapots", "contact", "FCL steps", "the paper's OPCODE", "microseconds per query",
                           "30k", "boxes", "hollow: other libraries"}) {
    CHECK_THAT(folder.read("table1.svg"), Contains(std::string("<text>") + text + "</text>"));
  }
  CHECK_THAT(folder.read("index.html"), Contains("<img src=\"table1.svg\">"));
}

TEST_CASE("a front is drawn with its title, the name of each of its methods, and where it is from") {
  const test::ScratchFolder folder;
  std::vector<Cell> cells{madeUp("sampled", 5, 0.1, 3), madeUp("contact", 1, 0), madeUp("Embree rays", 20, 0.01)};
  const Json report = summed(cells, {"w"}, folder);
  for (const std::string& text :
       {std::string("w"), std::string("About"), std::string("sampled"), std::string("contact"),
        std::string("Embree rays"), std::string("on the front"), std::string("wrong answers, % of queries"),
        std::string("worst error, in sensor sizes"), std::string("Other libraries (hollow)"),
        "some device; " + report["processor"].get<std::string>() + "; commit " + report["commit"].get<std::string>()}) {
    CHECK_THAT(folder.read("front-w.svg"), Contains("<text>" + text + "</text>"));
  }
  cells.pop_back();
  summed(cells, {"w"}, folder);
  CHECK_THAT(folder.read("front-w.svg"), Contains("sampled") && !Contains("ther libraries"));
}
