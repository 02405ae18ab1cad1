// Cases whose answers are known.
#include "known_cases.h"
#include "support/answer.h"

using namespace radar;
using test::add;
using test::at;

TEST_CASE("the CPU gives the known answers about boxes among boxes") {
  known::check(
      [](const Scene& scene, const std::vector<Query>& queries) { return CpuSweeper(scene, 1).run(queries).results; });
}

TEST_CASE("an edge-on plate is hit on its rim") {
  Scene scene;
  const MeshId box = add(scene, tools::makeBox({2, 2, 2}));
  const MeshId plate = add(scene, {"", {0, 0, -3, 0, 0, 3, 0, 8, -3, 0, 8, 3}, {0, 1, 2, 2, 1, 3}});
  scene.addObject({plate, at(0.25, 2, 0)});
  CpuSweeper sweeper(scene);
  const Result result = test::answer(sweeper, {.mesh = box, .direction = {0, 1, 0}, .distance = 10});
  REQUIRE(result.status == Status::hit);
  REQUIRE(result.t == 1);
  const Result reverse =
      test::answer(sweeper, {.mesh = box, .worldFromMesh = at(0, 20, 0), .direction = {0, -1, 0}, .distance = 10});
  REQUIRE(reverse.t == 9);
}

TEST_CASE("two plates in one plane meet at their rims") {
  Scene scene;
  const MeshId plate = add(scene, {"", {0, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 1, 2}});
  scene.addObject({plate, at(0, 4, 0)});
  CpuSweeper sweeper(scene);
  REQUIRE(test::answer(sweeper, {.mesh = plate, .direction = {0, 1, 0}, .distance = 10}).t == 3);
  REQUIRE(
      test::answer(sweeper, {.mesh = plate, .worldFromMesh = at(1e-9, 0, 0), .direction = {0, 1, 0}, .distance = 10})
          .status == Status::clear);
}

TEST_CASE("objects that cross the sensor are skipped and listed, those that touch it are not") {
  Scene scene;
  const MeshId box = add(scene, tools::makeBox({1, 1, 1}));
  const ObjectId crossing = scene.addObject({box, at(0.5, 0.5, 0.5)}), resting = scene.addObject({box, at(0, 0, -1)}),
                 wall = scene.addObject({box, at(3, 0, 0)});
  Query query{.mesh = box, .direction = {1, 0, 0}, .distance = 10, .ignoreLeaving = true, .skipOverlapping = true};
  CpuSweeper sweeper(scene, 1);
  const Answers answers = sweeper.run({&query, 1});
  REQUIRE(answers.results[0].object == wall);
  REQUIRE(answers.results[0].t == 2);
  REQUIRE(answers.lists[0].overlapping == std::vector{crossing});
  query.ignoreLeaving = false;  // then the box below, which is only touched, ends the motion
  REQUIRE(test::answer(sweeper, query).object == resting);
}

TEST_CASE("options that do not go together are refused by name") {
  Scene scene;
  const MeshId box = add(scene, tools::makeBox({1, 2, 3})), ball = add(scene, {"", {0, 0, 0}, {0, 0, 0}});
  scene.addObject({box, at(5, 0, 0)});
  const auto refusal = [&](Mode mode, MeshId mesh, const auto& change) {
    Query query{.mesh = mesh, .direction = {1, 0, 0}, .distance = 10};
    change(query);
    return validate(query, scene, mode);
  };
  CHECK_THAT(refusal(Mode::contact, box, [](Query& q) { q.anyHit = true, q.hits = 2; }),
             test::StartsWith("hits: expected 1 with anyHit, got 2"));
  CHECK_THAT(refusal(Mode::contact, box,
                     [](Query& q) {
                       q.motion = {{1, 0, 0}};
                     }),
             test::StartsWith("motion: expected no direction and no distance beside it"));
  for (void (*change)(Query&) : {+[](Query& q) { q.ignoreLeaving = true; }, +[](Query& q) { q.skipOverlapping = true; },
                                 +[](Query& q) { q.clearance = 0.1; }, +[](Query& q) { q.hits = kAllHits; }}) {
    CHECK(refusal(Mode::contact, box, change) == "");
    CHECK_THAT(refusal(Mode::sampled, box, change), test::StartsWith("mode: expected contact with ignoreLeaving"));
  }
  // A slack that would let shapes pass each other: of a box 3 long, and of a ball, which is a point with a clearance.
  const auto slack = [&](MeshId mesh, double clearance, double much) {
    return refusal(Mode::contact, mesh,
                   [=](Query& q) { q.ignoreLeaving = true, q.clearance = clearance, q.slack = much; });
  };
  CHECK(slack(box, 0, 0.3) == "");
  CHECK(
      slack(box, 0, 0.31) ==
      "slack: expected at most a tenth of the sensor's size or of the clearance, the greater of which is 3, got 0.31");
  CHECK(slack(box, 4, 0.31) == "");
  CHECK_THAT(slack(box, 0, 1e308), test::EndsWith("got 1e+308"));
  CHECK(slack(ball, 0.25, 0.025) == "");
  CHECK_THAT(slack(ball, 0.25, 1e308), test::EndsWith("which is 0.25, got 1e+308"));
}
