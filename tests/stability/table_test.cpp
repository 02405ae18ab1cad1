#include "stability/measure.h"
#include "support/catch.h"

using namespace radar::tools;

namespace {

constexpr Approach kPaper{64, true}, kSampled{64}, kContact;

StabilityRow rowOf(const char* family, const Approach& asked, uint64_t missed, double late) {
  StabilityRow row{family, asked, {}};
  row.tally.queries = 10;
  row.tally.hits = 7;
  row.tally.faults[static_cast<size_t>(Fault::missed)] = row.tally.wrong = missed;
  row.tally.late = late;
  return row;
}

}  // namespace

TEST_CASE("only what is promised can be broken") {
  CHECK(rowOf("thin", kPaper, 3, 0).right());
  CHECK_FALSE(rowOf("thin", kSampled, 1, 0).right());
  StabilityRow row = rowOf("thin", kSampled, 0, 0);
  row.tally.unseen = 3;
  CHECK(row.right());
  CHECK(row.missed() == 3);
}

TEST_CASE("rows over families add up counts and keep the worst") {
  const std::vector<StabilityRow> rows{rowOf("thin", kPaper, 2, 0.5), rowOf("thin", kContact, 0, 0),
                                       rowOf("slope", kPaper, 3, 0.25), rowOf("slope", kContact, 0, 1)};
  const std::vector<StabilityRow> all = overFamilies(rows);
  REQUIRE(all.size() == 2);
  CHECK(all[0].asked.paper);
  CHECK(all[0].tally.queries == 20);
  CHECK(all[0].missed() == 5);
  CHECK(all[0].tally.late == 0.5);
  CHECK(all[1].tally.late == 1);
  const std::vector<StepRow> steps = overFamilies(std::vector<StepRow>{
      {"thin", kSampled, 10, 1, 0.5}, {"thin", kContact, 10, 0, 0}, {"slope", kSampled, 20, 2, 0.25}});
  REQUIRE(steps.size() == 2);
  CHECK((steps[0].steps == 30 && steps[0].flips == 3 && steps[0].excess == 0.5));
}

TEST_CASE("a row is a line of the table") {
  const std::string csv = csvOf(tableOf(std::vector{rowOf("thin", kPaper, 2, 0.5)}));
  CHECK(csv.substr(csv.find('\n') + 1) == "thin,paper,64,10,7,2,0,0,0,0.5,0\n");
  CHECK(csvOf(tableOf(std::vector<StepRow>{{"slope", kSampled, 512, 1, 2.5e-6}})) ==
        "family,tier,steps,flips,excess\nslope,sampled,512,1,2.5e-06\n");
  CHECK(csvOf(tableOf(std::vector<ChangeRow>{{"triangles cut in two", kContact, 8, 5, 1}})) ==
        "change,tier,cases,contacts,broken\ntriangles cut in two,contact,8,5,1\n");
  const std::vector<HardFamily> family{{"far", "by the pose, in units", {0, 1e-6}, nullptr}};
  CHECK(csvOf(tableOf(family)) == "family,parameter,values\nfar,\"by the pose, in units\",0 1e-06\n");
}
