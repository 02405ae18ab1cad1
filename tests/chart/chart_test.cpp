#include "chart/charts.h"
#include "chart/run.h"
#include "support/answer.h"
#include "support/catch.h"
#include "support/scratch_folder.h"
#include "support/test_device.h"
#include "workloads/generate.h"
#include "workloads/hard_cases.h"

using namespace radar;
using namespace radar::tools;
using test::Contains;
using test::StartsWith;

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

RunSettings smallRun() {
  RunSettings settings;
  settings.extent = Extent::least;
  settings.methods = [](const std::string& section) { return ours(test::device(), section, Extent::least, 2); };
  settings.cases.push_back({"front", "locked", "Interlocking shapes", 0,
                            hardScene(hardFamily("interlocking"), 1, 0, 12, Company::isolated)});
  settings.cases.push_back(
      {"front", "flight", "Teapots in flight", 0, makeWorkload(Figure7{.teapots = 4, .boxes = 2000, .steps = 2})});
  return settings;
}

Record run(const RunSettings& settings, const test::ScratchFolder& folder) {
  size_t steps = 0;
  Record record = measureAll(settings, {}, folder.path(), [&] { ++steps; });
  CHECK(steps == record.cells.size());
  return record;
}

// Every column but those of time.
std::string accuracyOf(const Record& record) {
  Record bare = record;
  for (Cell& cell : bare.cells) {
    cell.passes = 0;
    cell.prepareMs = cell.us = cell.usLow = cell.usHigh = cell.cpuUs = cell.sceneUs = NAN;
  }
  return csvOf(bare);
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
  Record record;
  record.cells = {madeUp("m", 4, 0), madeUp("m", 3, 0), madeUp("broken", NAN, NAN)};
  record.cells[1].threads = 2;
  record.cells[2].failed = "crashes: Segmentation fault";
  const std::vector<const Cell*> shown = shownCells(record, "front", "w");
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

TEST_CASE("a record read is the record written, and a damaged one is refused with its place") {
  Record record;
  record.add("command", "cyber-radar chart \"x\"");
  record.add("workload", "w: About: \"w\",\n#1");
  record.add("workload", "v: ");
  record.cells = {madeUp("a", 0.1, 1.0 / 3), madeUp("b, \"quoted\"", NAN, NAN)};
  record.cells[1].failed = "#1\n2";
  record.cells[1].certified = true;
  const std::string csv = csvOf(record);
  const Record again = recordFrom(csv, "chart.csv");
  CHECK(csvOf(again) == csv);
  CHECK(again.values("command") == std::vector<std::string>{"cyber-radar chart \"x\""});
  CHECK(again.values("workload") == std::vector<std::string>{"w: About: \"w\", #1", "v: "});
  CHECK(again.values("run").empty());
  REQUIRE(again.cells.size() == 2);
  CHECK(again.cells[0].errorWorst == 1.0 / 3);
  CHECK(std::isnan(again.cells[1].us));
  CHECK(again.cells[1].method == record.cells[1].method);
  CHECK(again.cells[1].failed == record.cells[1].failed);
  CHECK(again.cells[1].certified);
  CHECK_THAT(csv, Contains("\"b, \"\"quoted\"\"\"") && Contains("0.3333333333333333,"));
  const auto refused = [](std::string text, const std::string& from, const std::string& to, const std::string& why) {
    text.replace(text.find(from), from.size(), to);
    CHECK_THROWS_WITH(recordFrom(text, "chart.csv"), StartsWith("chart.csv: ") && Contains(why));
  };
  refused(csv, ",workload,", ",job,", "columns: expected");
  refused(csv, "0.3333333333333333", "a third", "row 1: error_worst: expected a number, got \"a third\"");
  refused(csv, ",yes,", ",maybe,", "row 2: certified: expected yes or no, got \"maybe\"");
  refused(csv, ",yes,", ",yes,1,", "row 2: expected");
  refused(csv, "2\",", "2,", "expected a closing quote");
}

TEST_CASE("the accuracy columns of two runs are the same to the last digit, and every certificate holds") {
  const test::ScratchFolder folder, other;
  const Record first = run(smallRun(), folder);
  CHECK(accuracyOf(first) == accuracyOf(run(smallRun(), other)));
  for (const Cell& cell : first.cells) {
    CAPTURE(cell.workload, cell.method);
    CHECK(cell.violations == 0);
    CHECK(cell.us > 0);
    CHECK(cell.contacts > 0);
    if (cell.certified) CHECK(cell.wrongShare() == 0);
  }
}

TEST_CASE("the tables sum up every method over all workloads, and tell where it fails") {
  Record record;
  record.head = {"workload: w: Shapes", "workload: v: Others", "workload: none: Not measured"};
  record.cells = {madeUp("contact", 2, 0), madeUp("FCL steps", 4, 0), madeUp("FCL steps", 9, 0.1, 1),
                  madeUp("contact", 5, 0), madeUp("ODE steps", 1, 0, 3)};
  record.cells[1].size = 16;
  record.cells[1].method = "FCL steps 16";
  record.cells[2].size = 64;
  record.cells[2].method = "FCL steps 64";
  for (size_t i = 3; i < record.cells.size(); ++i) record.cells[i].workload = "v";
  for (const uint32_t size : {16, 64}) {
    Cell& broken = record.cells.emplace_back(madeUp("ODE steps " + std::to_string(size), NAN, NAN));
    broken.size = size;
    broken.family = "ODE steps";
    broken.failed = "crashes";
  }
  CHECK(csvOf(methodTable(record)) ==
        "method,wrong_percent,on_worst_workload,worst_error,us_least,us_most,fails_on\n"
        "contact,0,0,0,2,5,none\nFCL steps 16,0,0,0,4,4,v none\nFCL steps 64,10,10,0.1,9,9,v none\n"
        "ODE steps,30,30,0,1,1,w none\n");
  CHECK(csvOf(workloadTable(record)) ==
        "workload,queries,contacts,contact,contact on device,reference,sampled 64,fastest_other_always_right,us\n"
        "w,10,10,2,,,,FCL steps 16,4\nv,10,10,5,,,,none,\n");
}

TEST_CASE("growing work is described from its first row to its last, beside the paper's times of Table 1") {
  Record record;
  for (const double boxes : {10'000.0, 20'000.0, 30'000.0}) {
    for (const char* method : {"contact", "FCL steps 64"}) {
      Cell& cell = record.cells.emplace_back(madeUp(method, method == std::string("contact") ? 4 : boxes / 5'000, 0));
      cell.section = "table1";
      cell.workload = "boxes";
      cell.x = boxes;
    }
  }
  const std::string csv = csvOf(growthTable(record));
  CHECK_THAT(csv, Contains("\ntable1,contact,10000,4,30000,4,1\ntable1,FCL steps 64,10000,2,30000,6,3\n"));
  CHECK_THAT(csv, Contains("\ntable1,the paper's OPCODE,10000,11270,30000,85480,7.58"));
}
