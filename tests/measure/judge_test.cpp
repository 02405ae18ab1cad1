#include "measure/judge.h"

#include <cmath>

#include "support/answer.h"
#include "support/catch.h"
#include "workloads/hard_cases.h"
#include "workloads/shapes.h"

using namespace radar;
using namespace radar::tools;

namespace {

/// A box that moves 2 up to another one: hit at t = 2.
struct Boxes {
  Boxes() {
    const HardCase hard{
        {makeBox({1, 1, 1}), {}}, {{makeBox({1, 1, 1}), {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 3}}}}, {0, 0, 1}, 5};
    const Workload workload = sceneOf({hard}, Company::isolated);
    replaceBy(workload, 0, scene);
    query = workload.queries[0];
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
    return judge(boxes.scene, boxes.query, Mode::contact, result, boxes.exact).words();
  };
  REQUIRE(boxes.exact.t == 2);
  CHECK(judged([](Result&) {}).empty());
  CHECK(judged([](Result& r) {
          r.status = Status::clear;
          r.t = r.lo = r.hi = INFINITY;
        }).starts_with("missed"));
  const auto next = [](double& x) { x = std::nextafter(x, INFINITY); };
  CHECK(judged([](Result& r) { r.status = Status::invalid; }) == "not answered, wrong status");
  CHECK(judged([](Result& r) { r.status = Status::undecided; }) == "wrong status");
  CHECK(judged([](Result& r) { r.status = Status::overlap; }) == "wrong status");
  CHECK(judged([](Result& r) { r.detected = Detected::notLooked; }) == "wrong status");
  CHECK(judged([](Result& r) { r.triB ^= 1; }) == "wrong pair");
  CHECK(judged([](Result& r) { r.featureA = Feature::vertex; }) == "wrong pair");
  CHECK(judged([&](Result& r) { next(r.lo); }) == "bracket");
  CHECK(judged([&](Result& r) { next(r.hi); }) == "bracket");
  CHECK(judged([&](Result& r) { next(r.t); }) == "late");
  CHECK(judged([&](Result& r) { next(r.fraction); }) == "late");
  CHECK(judged([&](Result& r) { next(r.point[2]); }) == "point");
  CHECK(judged([&](Result& r) { next(r.gap); }) == "point");
  CHECK(judged([](Result& r) { r.normal[2] = NAN; }) == "normal");
}

TEST_CASE("a decision in mode sampled says nothing but whether there is a contact") {
  const Boxes boxes;
  Query query = boxes.query;
  query.anyHit = true;
  Result decision = test::answer(boxes.scene, query);
  CHECK(judge(boxes.scene, query, Mode::sampled, decision, boxes.exact).words().empty());
  decision.object = 0;
  CHECK(judge(boxes.scene, query, Mode::sampled, decision, boxes.exact)[Fault::wrongPair]);
  decision.status = Status::overlap;
  CHECK(judge(boxes.scene, query, Mode::sampled, decision, boxes.exact)[Fault::wrongStatus]);
  CHECK_FALSE(judge(boxes.scene, query, Mode::sampled, boxes.exact, boxes.exact).right());
}

TEST_CASE("an upper bound before the exact t, a lower one, and a contact or a clear that is none are violations") {
  const Boxes boxes;
  const auto judged = [&](const Result& result, const Result& exact) {
    return judge(boxes.scene, boxes.query, Mode::sampled, result, exact);
  };
  Result result = boxes.exact;
  result.lo = 0;
  result.t = result.hi = 2.1;
  CHECK(judged(result, boxes.exact).words().empty());
  CHECK(judged(result, boxes.exact).error == Approx(0.05));
  result.lo = 1.9;
  CHECK(judged(result, boxes.exact)[Fault::bracket]);
  result.lo = 0;
  result.t = result.hi = 1.9;
  CHECK(judged(result, boxes.exact)[Fault::bracket]);
  const Result clear(Status::clear);
  CHECK(judged(clear, boxes.exact)[Fault::missed]);
  CHECK(judged(boxes.exact, clear)[Fault::falseHit]);
  Result undecided(Status::undecided);
  undecided.lo = 0;
  CHECK(judged(undecided, boxes.exact).words().empty());
  CHECK(judged(undecided, boxes.exact).unseen);
  undecided.lo = 1.5;
  CHECK(judged(undecided, boxes.exact)[Fault::bracket]);
}

TEST_CASE("a tally adds up verdicts and keeps the largest errors") {
  const Result clear(Status::clear);
  Result exact;
  exact.status = Status::hit;
  exact.t = exact.lo = exact.hi = 2;
  Tally tally, other;
  tally.add(judge(test::madeUpAnswer(Status::hit, 3, NAN, NAN), exact, 2), exact);
  tally.add(judge(test::madeUpAnswer(Status::hit, 1.5, 1, 1.75), exact, 2), exact);
  other.add(judge(test::madeUpAnswer(Status::clear, NAN, NAN, NAN), exact, 2), exact);
  other.add(judge(test::madeUpAnswer(Status::undecided, NAN, NAN, NAN), exact, 2), exact);
  other.add(judge(test::madeUpAnswer(Status::hit, 1, NAN, NAN), clear, 2), clear);
  tally.add(other);
  CHECK(tally.queries == 5);
  CHECK(tally.contacts() == 4);
  CHECK(tally.wrong == 3);
  CHECK(tally[Fault::missed] == 1);
  CHECK(tally[Fault::falseHit] == 1);
  CHECK(tally[Fault::bracket] == 1);
  CHECK(tally.unseen == 1);
  CHECK(tally.late == 0.5);
  CHECK(tally.early == 0.25);
}
