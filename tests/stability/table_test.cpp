#include "stability/table.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "stability/page.h"

using namespace radar::tools;
using Catch::Matchers::Contains;

namespace {

StabilityRow rowOf(const char* family, Method method, uint64_t missed, double late) {
  StabilityRow row;
  row.family = family;
  row.method = method;
  row.resolution = method == Method::contact ? 0 : 64;
  row.cases = 10;
  row.missed = missed;
  row.late = late;
  row.width = NAN;
  return row;
}

}  // namespace

TEST_CASE("only what is promised can be broken") {
  CHECK(rowOf("thin", Method::paper, 3, 0).right());
  CHECK(rowOf("thin", Method::sampled, 3, 0).right());
  CHECK_FALSE(rowOf("thin", Method::contact, 1, 0).right());
  for (uint64_t StabilityRow::*number :
       {&StabilityRow::falseHits, &StabilityRow::brackets, &StabilityRow::otherwise, &StabilityRow::undecided}) {
    StabilityRow row = rowOf("thin", Method::contact, 0, 0);
    CHECK(row.right());
    row.*number = 1;
    CHECK_FALSE(row.right());
    row.method = Method::sampled;
    CHECK(row.right() == (number == &StabilityRow::undecided));
  }
}

TEST_CASE("rows over families add up counts and keep the worst") {
  const std::vector<StabilityRow> rows{rowOf("thin", Method::paper, 2, 0.5), rowOf("thin", Method::contact, 0, 0),
                                       rowOf("slope", Method::paper, 3, 0.25), rowOf("slope", Method::contact, 0, 1)};
  const std::vector<StabilityRow> all = overFamilies(rows);
  REQUIRE(all.size() == 2);
  CHECK(all[0].method == Method::paper);
  CHECK(all[0].cases == 20);
  CHECK(all[0].missed == 5);
  CHECK(all[0].late == 0.5);
  CHECK(all[1].late == 1);
  CHECK(std::isnan(all[0].width));
}

TEST_CASE("a row is a line of the table") {
  const std::string csv = csvOf({rowOf("thin", Method::paper, 2, 0.5)});
  CHECK(csv.substr(csv.find('\n') + 1) == "thin,paper,64,10,0,2,0,0,0,0.5,0,nan,0,0,0,0,0.00\n");
  CHECK(csvOf(std::vector<StepRow>{{"slope", Method::sampled, 512, 1, 2.5e-6}}) ==
        "family,tier,steps,flips,excess\nslope,sampled,512,1,2.5e-06\n");
  CHECK(csvOf(std::vector<ChangeRow>{{Change::cut, Method::contact, 8, 5, 1}}) ==
        "change,tier,cases,contacts,broken\ntriangles cut in two,contact,8,5,1\n");
  const std::vector<StabilityFamily> family{{"far", "by the pose, in units", {0, 1e-6}, nullptr}};
  CHECK(csvOf(family) == "family,parameter,values\nfar,\"by the pose, in units\",0 1e-06\n");
}

TEST_CASE("steps over families add up and keep the largest excess, method by method") {
  const std::vector<StepRow> rows{{"thin", Method::sampled, 10, 1, 0.5},
                                  {"thin", Method::contact, 10, 0, 0},
                                  {"slope", Method::sampled, 20, 2, 0.25},
                                  {"slope", Method::contact, 20, 0, 1e-15}};
  const std::vector<StepRow> all = overFamilies(rows);
  REQUIRE(all.size() == 2);
  CHECK(all[0].method == Method::sampled);
  CHECK(all[0].steps == 30);
  CHECK(all[0].flips == 3);
  CHECK(all[0].excess == 0.5);
  CHECK(all[1].method == Method::contact);
  CHECK(all[1].excess == 1e-15);
}

TEST_CASE("the page tells what mode contact got wrong, and leaves the rows to the tables") {
  StabilityFindings findings;
  findings.report.rows = {rowOf("thin", Method::sampled, 3, 0.5), rowOf("slope", Method::sampled, 1, 0.25),
                          rowOf("thin", Method::contact, 0, 0), rowOf("slope", Method::contact, 2, 0)};
  findings.steps = {{"thin", Method::contact, 7, 1, 0.125}};
  findings.changes = {{Change::cut, Method::contact, 8, 5, 1}, {Change::moved, Method::contact, 8, 5, 2}};
  findings.pictures = {{"stability/thin.png", "A rod", "Why."}};
  const StabilityOrigin origin{"cyber-radar stability", "c0ffee", "today", "a device", "a driver"};
  const std::string page = pageOf(findings, origin);
  CHECK_THAT(page,
             Contains("gave 20 answers: 2 contacts missed, 0 invented") && Contains("equals the CPU's to the bit"));
  CHECK_THAT(page, Contains("| sampled 64 | 0 | 4 | 0 | 0.5 | 0 |") && !Contains("slope |"));
  CHECK_THAT(page, Contains("`contact`: 1 flips, excess 0.12") && Contains("in 7 steps") && Contains("Of 16 pairs"));
  CHECK_THAT(page, Contains("3 are contradictory") && Contains("**A rod.** Why.\n\n![R, M and L](stability/thin.png)"));
  CHECK_THAT(page, Contains("cyber-radar stability\n") && Contains("driver a driver, commit c0ffee"));
  findings.report.rows[2].early = 1e-9;
  CHECK_THAT(pageOf(findings, origin), Contains("within 1.0e-09 of the CPU's") && !Contains("to the bit"));
}
