#include "stability/promises.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "support/answer.h"
#include "workloads/shapes.h"
#include "workloads/stability.h"

using namespace radar;
using namespace radar::tools;

namespace {

/// A box that moves 2 up to another one: hit at t = 2.
struct Boxes {
  Boxes() {
    const StabilityCase made{
        {makeBox({1, 1, 1}), {}}, {{makeBox({1, 1, 1}), {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 3}}}}, {0, 0, 1}, 5};
    const Workload workload = workloadOf({made});
    replaceBy(workload, 0, scene);
    query = toQuery(workload.queries[0], Mode::contact);
    exact = test::answer(scene, query);
  }
  Scene scene;
  Query query;
  Result exact;
};

}  // namespace

TEST_CASE("the exact answer keeps every promise, and whatever is changed in it breaks one") {
  const Boxes boxes;
  const auto judged = [&](auto change) {
    Result result = boxes.exact;
    change(result);
    return judgeContact(boxes.scene, boxes.query, result, boxes.exact).words();
  };
  REQUIRE(boxes.exact.t == 2);
  CHECK(judged([](Result&) {}) == "");
  CHECK(judged([](Result& r) {
          r.status = Status::clear;
          r.t = r.lo = r.hi = NAN;
        }) == "missed");
  CHECK(judged([](Result& r) { r.status = Status::undecided; }) == "not answered");
  CHECK(judged([](Result& r) { r.status = Status::overlap; }).starts_with("hit for overlap"));
  CHECK(judged([](Result& r) { r.triB ^= 1; }).find("wrong pair") != std::string::npos);
  CHECK(judged([](Result& r) { r.lo = 2.001; }).find("bracket violated") != std::string::npos);
  CHECK(judged([](Result& r) { r.hi = 1.999; }).find("bracket violated") != std::string::npos);
  CHECK(judged([](Result& r) { r.t = 2.00001; }).find("t off") != std::string::npos);
  CHECK(judged([](Result& r) { r.point[2] += 0.01; }).find("point") != std::string::npos);
  CHECK(judged([](Result& r) { r.normal[2] = -r.normal[2]; }).find("normal") != std::string::npos);
}

TEST_CASE("an upper bound before the exact t, a lower one, and a contact or a clear that is none are violations") {
  const Boxes boxes;
  Result result = boxes.exact;
  result.lo = 0;
  result.t = result.hi = 2.1;
  CHECK(judgeSampled(boxes.query, result, boxes.exact).words() == "");
  result.lo = 1.9;
  CHECK(judgeSampled(boxes.query, result, boxes.exact).bracket);
  result.lo = 0;
  result.t = result.hi = 1.9;
  CHECK(judgeSampled(boxes.query, result, boxes.exact).bracket);
  Result clear;
  clear.status = Status::clear;
  CHECK(judgeSampled(boxes.query, clear, boxes.exact).missed);
  CHECK(judgeSampled(boxes.query, boxes.exact, clear).falseHit);
  Result undecided;
  undecided.status = Status::undecided;
  undecided.lo = 0;
  CHECK(judgeSampled(boxes.query, undecided, boxes.exact).words() == "");
  undecided.lo = 1.5;
  CHECK(judgeSampled(boxes.query, undecided, boxes.exact).bracket);
}
