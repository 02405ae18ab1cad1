#include "stability/measure.h"

#include <cmath>

#include "support/answer.h"
#include "support/catch.h"
#include "support/test_device.h"
#include "workloads/same_contact.h"

using namespace radar;
using namespace radar::tools;

namespace {

Result answered(Status status, double lo, double hi) {
  return test::madeUpAnswer(status, NAN, lo, hi);
}

Result exactAnswer(const HardCase& hard) {
  const Workload workload = sceneOf({hard}, Company::isolated);
  Scene scene;
  replaceBy(workload, 0, scene);
  return test::answer(scene, workload.queries[0]);
}

}  // namespace

TEST_CASE("two answers agree when one contact can be in both brackets") {
  const Result hit = answered(Status::hit, 1, 2), clear = answered(Status::clear, NAN, NAN);
  CHECK(agree(hit, answered(Status::hit, 2, 3)));
  CHECK_FALSE(agree(hit, answered(Status::hit, 2.5, 3)));
  CHECK_FALSE(agree(hit, clear));
  CHECK(agree(hit, answered(Status::undecided, 2, NAN)));
  CHECK_FALSE(agree(answered(Status::undecided, 2.5, NAN), hit));
  CHECK(agree(clear, clear));
  CHECK_FALSE(agree(clear, answered(Status::overlap, 0, 0)));
}

TEST_CASE("the changes leave the exact answer where it is, to the bit") {
  uint32_t contacts = 0;
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const HardCase hard = dyadicCase(random);
    const Result exact = exactAnswer(hard);
    contacts += exact.status != Status::clear;
    for (const HardCase& changed :
         {movedTogether(hard, random), changedPlaces(hard), cutInTwo(hard, random), withFarObjects(hard, random)}) {
      const Result again = exactAnswer(changed);
      CHECK(again.status == exact.status);
      CHECK(again.t == exact.t);
    }
  }
  CHECK(contacts > 80);
  CHECK(contacts < 180);
}

TEST_CASE("moving, swapping, cutting, adding far objects and splitting D change no answer beyond its bracket") {
  const auto onBroken = [](const std::string& words) { UNSCOPED_INFO(words); };
  const std::vector<ChangeRow> rows =
      measureChanges(test::device(), {.cases = 64, .seed = 5}, onBroken, [](uint64_t) {});
  CHECK(rows.size() == 2 * 5);
  for (const ChangeRow& row : rows) {
    CAPTURE(row.change, row.asked.tier());
    CHECK(row.cases == 64);
    CHECK(row.contacts >= 16);
    CHECK(row.broken == 0);
  }
}
