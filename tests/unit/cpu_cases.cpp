// Cases whose answers are known.
#include <cmath>

#include "support/answer.h"
#include "support/catch.h"
#include "support/world.h"
#include "workloads/shapes.h"

using namespace radar;
using test::add;
using test::at;
using tools::Vec3;
using tools::operator+;
using tools::operator-;
using tools::operator*;

namespace {

struct Box {
  Vec3 from, to;
};

/// A sweep of the sensor, and its answer.
struct Sweep {
  Vec3 direction;
  double distance;
  Status status;
  double t = 0;
  ObjectId object = 0;
  Vec3 start{};  ///< by how much the sensor is moved first
  std::vector<ObjectId> exclude{};
  uint32_t mask = ~0u;  ///< object i has bit i % 32
};

struct Case {
  const char* name;
  Box sensor;
  std::vector<Box> objects;
  std::vector<Sweep> sweeps;
  bool ignoreLeaving = false;
};

std::vector<Case> cases() {
  constexpr Status kClear = Status::clear, kHit = Status::hit, kOverlap = Status::overlap;
  constexpr Vec3 kUp{0, 0, 1}, kDown{0, 0, -1}, kRight{1, 0, 0}, kLeft{-1, 0, 0}, kAhead{0, 1, 0}, kBack{0, -1, 0};
  const auto before = [](double x) { return std::nextafter(x, 0); };
  const auto beyond = [](double x) { return std::nextafter(x, 2 * x); };
  constexpr Box kCube{{0, 0, 0}, {1, 1, 1}}, kAbove{{0, 0, 4}, {1, 1, 5}}, kFloor{{-9, -9, -1}, {9, 9, 0}};
  std::vector<Box> row, field;
  for (int i = 0; i < 20; ++i) {
    const double x = 3.0 * ((7 * i) % 20);
    row.push_back({{x, 0, 4}, {x + 1, 1, 5}});
  }
  for (int i = 1023; i >= 0; --i) {
    const int column = i % 32, line = i / 32;
    const double x = 2 * column, y = 2 * line;
    field.push_back({{x, y, 4}, {x + 1, y + 1, 5}});
  }
  return {
      {"a box that falls on another hits it after the gap between them",
       {{0, 0, 5}, {2, 2, 7}},
       {{{0.25, 0.5, 0}, {2.25, 2.5, 2}}},
       {{{0, 0, -2}, 10, kHit, 3}}},
      {"contact at exactly D counts, and contact beyond D does not",
       kCube,
       {kAbove},
       {{kUp, 3, kHit, 3}, {kUp, before(3), kClear}, {{0, 0, 2}, 3, kHit, 3}, {{0, 0, 2}, 10, kHit, 3}}},
      {"touching at the start is an overlap, whatever D and the direction",
       kCube,
       {kAbove},
       {{kUp, 0, kOverlap, 0, 0, {0, 0, 3}},
        {kUp, 5, kOverlap, 0, 0, {0, 0, 3}},
        {kDown, 0, kOverlap, 0, 0, {0, 0, 3}},
        {kDown, 5, kOverlap, 0, 0, {0, 0, 3}},
        {kUp, 5, kOverlap, 0, 0, {0, 0, 3.5}},
        {kUp, 5, kOverlap, 0, 0, {0, 0, 5}},
        {kUp, 5, kClear, 0, 0, {0, 0, beyond(5)}},
        {kUp, 0, kClear, 0, 0, {0, 0, before(3)}},
        {kUp, 1, kHit, 3 - before(3), 0, {0, 0, before(3)}},
        {kUp, 0, kOverlap, 0, 0, {1, 1, 3}}}},
      {"boxes that slide past each other meet along an edge or at a corner, and one ulp beside it do not",
       kCube,
       {kAbove},
       {{kUp, 9, kHit, 3, 0, {1, 0, 0}},
        {kUp, 9, kClear, 0, 0, {beyond(1), 0, 0}},
        {kUp, 9, kHit, 3, 0, {1, 1, 0}},
        {kUp, 3, kHit, 3, 0, {1, 1, 0}},
        {kUp, 9, kHit, 3, 0, {-1, 0.5, 0}}}},
      {"a box inside another that does not reach its surface is clear",
       {{-1, -1, -1}, {1, 1, 1}},
       {{{-10, -10, -10}, {10, 10, 10}}},
       {{kRight, 8, kClear}, {kRight, 9, kHit, 9}}},
      {"the object behind is found when the one in front is excluded or masked",
       kCube,
       {kAbove, {{0, 0, 8}, {1, 1, 9}}},
       {{kUp, 20, kHit, 3, 0},
        {kUp, 20, kHit, 7, 1, {}, {0}},
        {kUp, 20, kHit, 7, 1, {}, {}, 2},
        {kUp, 20, kClear, 0, 0, {}, {}, 4}}},
      {"of objects in a row hit at the same time the one with the lowest id is reported",
       {{0, 0, 0}, {60, 1, 1}},
       row,
       {{kUp, 20, kHit, 3, 0}, {kUp, 20, kHit, 3, 1, {}, {0}}}},
      {"of a thousand objects hit at the same time the one with the lowest id is reported",
       {{0, 0, 0}, {64, 64, 1}},
       field,
       {{{0, 0, 0.5}, 10, kHit, 3, 0},
        {kUp, 10, kHit, 3, 1, {}, {0}},
        {kUp, 10, kHit, 3, 3, {}, {0, 1, 2}},
        {kUp, 3, kHit, 3, 0},
        {kUp, before(3), kClear}}},
      {"a box at rest may be lifted and pushed along the floor, but neither down nor through a wall",
       kCube,
       {kFloor, {{3, -9, 0}, {4, 9, 9}}},
       {{kUp, 10, kClear},
        {kLeft, 5, kClear},
        {kDown, 10, kOverlap},
        {{1, 0, -1e-9}, 10, kOverlap},
        {kRight, 10, kHit, 2, 1},
        {{2, 0, 0}, 10, kHit, 2, 1},
        {{1, 0, 1}, 10, kHit, 2 * std::sqrt(2.0), 1}},
       true},
      {"an edge that is only grazed, and left along its face, does not hide the wall behind it",
       kCube,
       {{{1, 1, -9}, {2, 2, 9}}, {{5, -9, -9}, {6, 9, 9}}},
       {{kRight, 10, kHit, 4, 1}},
       true},
      {"walls in one plane let a box slide along both",
       kCube,
       {{{-9, -1, -9}, {1, 0, 9}}, {{1, -1, -9}, {9, 0, 9}}},
       {{kRight, 5, kClear}, {{1, -1e-3, 0}, 5, kOverlap}},
       true},
      {"a peg that fits a hole exactly moves along its axis only",
       kCube,
       {{{-9, -9, -9}, {0, 9, 9}}, {{1, -9, -9}, {9, 9, 9}}, {{0, -9, -9}, {1, 0, 9}}, {{0, 1, -9}, {1, 9, 9}}},
       {{kUp, 10, kClear},
        {kDown, 10, kClear},
        {kRight, 10, kOverlap, 0, 1},
        {kBack, 10, kOverlap, 0, 2},
        {{1e-6, 0, 1}, 10, kOverlap, 0, 1}},
       true},
      {"a body inside a cavity meets the cavity's wall from inside",
       kCube,
       {{{-2, -2, -2}, {3, 3, 3}}},
       {{kAhead, 10, kHit, 2}},
       true},
      {"equal boxes stacked exactly let each other go upwards only",
       kCube,
       {{{0, 0, -1}, {1, 1, 0}}},
       {{kUp, 10, kClear},
        {kRight, 10, kClear},
        {{1, 1, 0}, 10, kClear},
        {kDown, 10, kOverlap},
        {{1, 0, -1}, 10, kOverlap}},
       true},
  };
}

}  // namespace

TEST_CASE("the CPU gives the known answers about boxes among boxes") {
  for (const Case& one : cases()) {
    Scene scene;
    const MeshId box = test::add(scene, tools::makeBox({1, 1, 1}));
    const auto placed = [](const Box& b) {
      return tools::makePose(tools::kUpright, b.to - b.from, 0.5 * (b.from + b.to));
    };
    for (size_t i = 0; i < one.objects.size(); ++i) scene.addObject({box, placed(one.objects[i]), 1u << i % 32});
    std::vector<Query> queries;
    for (const Sweep& sweep : one.sweeps) {
      Query query{.mesh = box,
                  .worldFromMesh = placed(one.sensor),
                  .direction = sweep.direction,
                  .distance = sweep.distance,
                  .exclude = sweep.exclude,
                  .mask = sweep.mask,
                  .ignoreLeaving = one.ignoreLeaving};
      tools::moveBy(query.worldFromMesh, sweep.start);
      queries.push_back(query);
    }
    const std::vector<Result> results = CpuSweeper(scene, 1).run(queries).results;
    for (size_t i = 0; i < queries.size(); ++i) {
      const Sweep& expected = one.sweeps[i];
      const Result& result = results.at(i);
      CAPTURE(one.name, i);
      REQUIRE(result.status == expected.status);
      if (expected.status == Status::clear) {
        CHECK((result.t == INFINITY && result.hi == INFINITY));
        continue;
      }
      CHECK(result.detected == Detected::yes);
      CHECK(result.object == expected.object);
      CHECK(result.t == expected.t);
      CHECK((result.lo <= expected.t && expected.t <= result.hi && result.hi <= expected.distance));
      CHECK(result.fraction == (expected.distance == 0 ? 0 : expected.t / expected.distance));
      if (expected.status == Status::overlap) CHECK((result.lo == 0 && result.hi == 0));
      for (size_t k = 0; k < 3 && expected.status == Status::hit; ++k) {
        Vec3 along{};
        along[k] = expected.direction[k];
        if (along == expected.direction) CHECK(result.normal[k] == (along[k] > 0 ? -1 : 1));
      }
    }
  }
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
