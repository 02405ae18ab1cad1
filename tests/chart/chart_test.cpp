#include <catch2/catch.hpp>
#include <csignal>

#include "chart/accuracy.h"
#include "chart/documents.h"
#include "chart/findings.h"
#include "chart/in_child.h"
#include "chart/run.h"
#include "support/scratch_folder.h"
#include "support/test_device.h"
#include "workloads/generate.h"
#include "workloads/hard_cases.h"

using namespace radar;
using namespace radar::tools;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

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
  std::vector<const Cell*> all;
  for (const Cell& cell : cells) all.push_back(&cell);
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
  settings.cases.push_back({"front", "locked", "Interlocking shapes", 0,
                            hardScene(hardFamily("interlocking"), 1, 0, 12, Company::isolated)});
  settings.cases.push_back(
      {"front", "flight", "Teapots in flight", 0, makeWorkload(Figure7{.teapots = 4, .boxes = 2000, .steps = 2})});
  return settings;
}

struct Ran {
  Record record;
  size_t steps = 0;
};

Ran run(const RunSettings& settings, const std::string& origin, const test::ScratchFolder& folder) {
  const std::vector<BaselineRow> none;
  const std::vector<Planned> plan = planOf(settings, none);
  Record start;
  start.run = fingerprintOf(settings, origin);
  start.workloads = {{"locked", "Interlocking shapes"}, {"flight", "Teapots in flight"}};
  Ran ran;
  ran.record = measureAll(settings, plan, start, test::device(), folder.path(), [&] { ++ran.steps; });
  CHECK(ran.steps == plan.size());
  return ran;
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

TEST_CASE("mode contact is compared with methods that sample, not with other certain ones") {
  std::vector<Cell> cells{madeUp("contact", 5, 0), madeUp("reference", 1, 0), madeUp("sampled", 2, 0, 1),
                          madeUp("Embree rays", 3, 0.2), madeUp("ODE/OPCODE steps", 12, 0)};
  const auto isOnFront = [&] {
    std::vector<const Cell*> all;
    for (const Cell& cell : cells) all.push_back(&cell);
    return isContactOnFrontBesideSampling(all);
  };
  CHECK(isOnFront());
  cells[4].us = 3;
  CHECK_FALSE(isOnFront());
  cells.erase(cells.begin());
  CHECK_FALSE(isOnFront());
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

TEST_CASE("slopes are those of power laws") {
  CHECK(slopeOf(std::vector<Point>{{1, 3}, {10, 3 * std::sqrt(10.0)}, {100, 30}}) == Approx(0.5));
}

TEST_CASE("answers are judged against the truth: errors, misses, inventions and broken promises") {
  using Kind = Claim::Kind;
  const std::vector<Result> truth{truthAt(2), truthAt(2), truthAt(NAN), truthAt(4), truthAt(4), truthAt(2)};
  const std::vector<double> sizes(6, 2);
  const std::vector<Claim> claims{{Kind::contact, 2.5, 1.5, 2.5}, {Kind::none},   {Kind::contact, 1, 0, 1},
                                  {Kind::contact, 3, 3, 4},       {Kind::unseen}, {Kind::contact, 2.5, 2.25, 2.75}};
  Cell cell;
  cell.certified = true;
  cell.queries = 6;
  judge(cell, claims, truth, sizes);
  CHECK(cell.contacts == 5);
  CHECK(cell.found == 3);
  CHECK(cell.misses == 2);
  CHECK(cell.falseHits == 1);
  CHECK(cell.violations == 3);  // the certain "none", the invented contact, the lower bound beyond t*
  CHECK(cell.errorMedian == 0.25);
  CHECK(cell.errorWorst == 0.5);
  CHECK(cell.widthWorst == 0.5);
  CHECK(wrongShare(cell) == 0.5);
}

TEST_CASE("a record read is the record written, and a damaged one is refused with its place") {
  Record record;
  record.command = "cyber-radar chart \"x\"";
  record.run = "0123";
  record.workloads = {{"w", "About: \"w\", #1"}};
  record.notes = {"one: text"};
  record.cells = {madeUp("a", 0.1, 1.0 / 3), madeUp("b, \"quoted\"", NAN, NAN)};
  record.cells[1].failed = "#1\n2";
  record.cells[1].certified = true;
  const std::string csv = csvOf(record);
  const Record again = recordFrom(csv, "chart.csv");
  CHECK(csvOf(again) == csv);
  CHECK(again.command == record.command);
  CHECK(again.run == record.run);
  REQUIRE(again.workloads.size() == 1);
  CHECK(again.workloads[0].about == record.workloads[0].about);
  CHECK(again.notes == record.notes);
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
  refused(csv, "chart-2", "chart-9", "line 1: expected");
  refused(csv, "# date", "# dates", "line 6: expected");
  refused(csv, ",workload,", ",job,", "columns: expected");
  refused(csv, "0.3333333333333333", "a third", "row 1: error_worst: expected a number, got \"a third\"");
  refused(csv, ",yes,", ",maybe,", "row 2: certified: expected yes or no, got \"maybe\"");
  refused(csv, ",yes,", ",yes,1,", "row 2: expected");
  refused(csv, "2\",", "2,", "expected a closing quote");
}

TEST_CASE("a run that was interrupted measures only what is missing, and all of it for another program") {
  const test::ScratchFolder folder;
  const RunSettings settings = smallRun();
  Record first = run(settings, "origin", folder).record;
  REQUIRE(first.cells.size() > 3);
  constexpr double kMark = 12'345;
  for (Cell& cell : first.cells) cell.us = kMark;
  const Cell lost = first.cells.back();
  first.cells.pop_back();
  writeRecord(folder.path(), first);
  const Record second = run(settings, "origin", folder).record;
  REQUIRE(second.cells.size() == first.cells.size() + 1);
  for (const Cell& cell : second.cells) CHECK((cell.us == kMark) == (&cell != &second.cells.back()));
  CHECK(second.cells.back().method == lost.method);
  RunSettings longer = settings;
  longer.cases[1].workload.queries[0].distance *= 2;
  for (const Cell& cell : run(longer, "origin", folder).record.cells) CHECK(cell.us != kMark);
  writeRecord(folder.path(), first);
  for (const Cell& cell : run(settings, "another", folder).record.cells) CHECK(cell.us != kMark);
}

TEST_CASE("the accuracy columns of two runs are the same to the last digit, and every certificate holds") {
  const test::ScratchFolder folder, other;
  const Record first = run(smallRun(), "origin", folder).record;
  CHECK(accuracyOf(first) == accuracyOf(run(smallRun(), "origin", other).record));
  for (const Cell& cell : first.cells) {
    CAPTURE(cell.workload, cell.method);
    CHECK(cell.violations == 0);
    CHECK(cell.us > 0);
    CHECK(cell.contacts > 0);
    if (cell.certified) CHECK(wrongShare(cell) == 0);
    CHECK(cell.settledSelect + cell.settledSampled + cell.settledContact + cell.settledReference == Approx(1));
  }
}

TEST_CASE("the documents link their charts, say where they come from and what other libraries cannot do") {
  Record record;
  record.command = "cyber-radar chart --out <here>";
  record.workloads = {{"w", "Shapes & more: of all kinds"}, {"none", "Not measured"}};
  record.notes = {"Baseline: cannot <that>"};
  record.cells = {madeUp("sampled", 3, 0.1, 2), madeUp("contact", 2, 0), madeUp("FCL steps", 1, 0, 10)};
  record.cells[2].errorWorst = NAN;
  const std::string accuracy = accuracyDocument(record, "chart"), performance = performanceDocument(record, "chart");
  CHECK_THAT(accuracy, Contains("![Shapes & more](chart/front-w.svg)") && Contains("- Baseline: cannot <that>"));
  CHECK_THAT(accuracy,
             !Contains("front-none.svg") && Contains("contact is on the front on 1 of 2 workloads, not on none."));
  for (const std::string& document : {accuracy, performance}) {
    CHECK_THAT(document, Contains("cyber-radar chart --out <here>") && !Contains("nan") && !Contains("inf "));
  }
}

TEST_CASE("the documents sum up every method over all workloads, and tell where it fails") {
  Record record;
  record.workloads = {{"w", "Shapes"}, {"v", "Others"}};
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
  const std::string accuracy = accuracyDocument(record, "chart"), performance = performanceDocument(record, "chart");
  CHECK_THAT(accuracy, Contains("| contact | 0.0% | 0.0% | 0 | 2 to 5 |"));
  CHECK_THAT(accuracy, Contains("| FCL steps 64 (fails on v) | 10.0% | 10.0% | 0.1 | 9 to 9 |"));
  CHECK_THAT(accuracy, Contains("| ODE steps (fails on w) | 30.0% | 30.0% | 0 | 1 to 1 |"));
  CHECK_THAT(accuracy, Contains("Not drawn: ODE steps 16, ODE steps 64 (crashes).") && !Contains("| FCL steps 16"));
  CHECK_THAT(accuracy, Contains("It took 2 to 5 µs per query; its worst error was 0."));
  CHECK_THAT(accuracy, Contains("on the front on 2 of 2 workloads."));
  CHECK_THAT(performance, Contains("| w | 2 | - | - | - | 4 (FCL steps 16) |"));
  CHECK_THAT(performance, Contains("| v | 5 | - | - | - | none |"));
  record.cells[4].misses = 0;
  CHECK_THAT(accuracyDocument(record, "chart"), Contains("on the front on 1 of 2 workloads, not on v."));
}

TEST_CASE("Table 1 is described from its first row to its last") {
  Record record;
  for (const double boxes : {10'000.0, 20'000.0, 30'000.0}) {
    for (const char* method : {"contact", "sampled 64", "FCL steps 64"}) {
      const bool isContact = std::string(method) == "contact", isFcl = std::string(method) == "FCL steps 64";
      Cell& cell = record.cells.emplace_back(madeUp(method, isContact ? 4 : isFcl ? boxes / 5'000 : 2'000, 0));
      cell.section = "table1";
      cell.workload = "boxes";
      cell.x = boxes;
    }
  }
  const std::string performance = performanceDocument(record, "chart");
  CHECK_THAT(performance, Contains("| µs per query among | 10,000 boxes | 30,000 boxes | ratio |"));
  CHECK_THAT(performance, Contains("| FCL steps 64 | 2 | 6 | 3.00 |"));
  CHECK_THAT(performance, Contains("| the paper's OPCODE | 11270 | 85480 | 7.58 |"));
  CHECK_THAT(performance, Contains("Mode contact takes 4 µs per query among 10,000 boxes and 4 µs among 30,000: 1.00"));
}

TEST_CASE("a child hands over numbers, an exception's words, the signal that ended it, or that it took too long") {
  CHECK(inChild([] { return std::vector<double>{1, 2.5}; }, 60).values == std::vector<double>{1, 2.5});
  const auto throws = []() -> std::vector<double> { throw std::runtime_error("no such thing"); };
  CHECK(inChild(throws, 60).failed == "no such thing");
  const auto dies = [] {
    std::raise(SIGKILL);
    return std::vector<double>();
  };
  CHECK_THAT(inChild(dies, 60).failed, Contains("crashes: Killed"));
  const auto never = [] {
    for (volatile bool on = true; on;) {
    }
    return std::vector<double>();
  };
  CHECK(inChild(never, 1).failed == "stopped after 1 s of processor time");
}
