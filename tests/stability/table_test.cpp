#include "stability/table.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace radar::tools;

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
  CHECK(markdownOf({rowOf("thin", Method::paper, 2, 0.5)}).find("| paper 64 | 10 | 0 | 2 | 0 | 0.5 | 0 |") !=
        std::string::npos);
}
