// Machines that fit with little room: what turns in them touches nothing, and does so once it is made a little wrong.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "radar/chain.h"
#include "radar/cpu_sweeper.h"
#include "support/catch.h"

using namespace radar;

namespace {

constexpr double kPi = std::numbers::pi;

/// A sheet of `columns` by `rows` quads, each of two triangles.
MeshId addSheet(Scene& scene, uint32_t columns, uint32_t rows,
                const std::function<std::array<double, 3>(uint32_t, uint32_t)>& vertex) {
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  for (uint32_t i = 0; i <= columns; ++i) {
    for (uint32_t k = 0; k <= rows; ++k) {
      for (const double value : vertex(i, k)) positions.push_back(static_cast<float>(value));
      if (i == columns || k == rows) continue;
      const uint32_t a = i * (rows + 1) + k, b = a + rows + 1;
      indices.insert(indices.end(), {a, b, a + 1, b, b + 1, a + 1});
    }
  }
  return scene.addMesh(positions, indices);
}

/// A V-shaped thread about z, its crest `radius` from it and its root a fifth less.
MeshId addThread(Scene& scene, double radius, double pitch, uint32_t turns) {
  constexpr uint32_t kAround = 48;
  return addSheet(scene, kAround * turns, 2, [&](uint32_t i, uint32_t k) {
    const double angle = 2 * kPi * i / kAround, r = k == 1 ? radius - 0.2 : radius;
    return std::array{r * std::cos(angle), r * std::sin(angle), pitch * (angle / (2 * kPi) + 0.5 * k)};
  });
}

/// An involute gear of module 1 about z: its flanks, with so much room along the pitch circle for each tooth.
MeshId addGear(Scene& scene, uint32_t teeth, double backlash, double width) {
  constexpr double kPressure = 20 * kPi / 180;
  constexpr uint32_t kFlank = 12, kPoints = 2 * kFlank + 2;  // of a tooth: up, down, and to the root on both sides
  const auto involute = [](double angle) { return std::tan(angle) - angle; };
  const double pitch = teeth / 2.0, base = pitch * std::cos(kPressure), tip = pitch + 1, root = pitch - 1.25;
  return addSheet(scene, teeth * kPoints, 1, [&](uint32_t i, uint32_t k) {
    const uint32_t point = i % kPoints;
    const bool isRoot = point == 0 || point == kPoints - 1, isUp = point <= kFlank;
    const double share = isRoot ? 0 : static_cast<double>(isUp ? point - 1 : kPoints - 2 - point) / (kFlank - 1);
    const double r = std::max(base, root) + share * (tip - std::max(base, root));
    const double half =
        kPi / (2 * teeth) - backlash / (2 * pitch) + involute(kPressure) - involute(std::acos(base / r));
    const double angle = 2 * kPi * (i / kPoints) / teeth + (isUp ? -half : half), at = isRoot ? root : r;
    return std::array{at * std::cos(angle), at * std::sin(angle), (k - 0.5) * width};
  });
}

Transform at(const std::array<double, 3>& place, double angle = 0) {
  Transform pose;
  pose.m = {std::cos(angle), -std::sin(angle), 0, place[0], std::sin(angle), std::cos(angle), 0, place[1], 0, 0, 1,
            place[2]};
  return pose;
}

}  // namespace

TEST_CASE("a bolt is unscrewed from its nut, and jams where its motion's pitch is off by a hundredth") {
  constexpr double kPitch = 0.4, kGap = 0.02, kTurns = 8;
  Scene scene;
  const MeshId bolt = addThread(scene, 1, kPitch, 12), nut = addThread(scene, 1 + kGap, kPitch, 3);
  scene.addObject({.mesh = nut});
  const auto unscrew = [&](double pitch) {
    // So long that it is in the nut all the time.
    Query query{.mesh = bolt,
                .worldFromMesh = at({0, 0, -kTurns * kPitch}),
                .motion = std::array<double, 3>{0, 0, kTurns * pitch}};
    query.turn = Turn{{0, 0, 1}, kTurns * 2 * kPi, {}};
    return CpuSweeper(scene).run({&query, 1}).results[0];
  };
  CHECK(unscrew(kPitch).status == Status::clear);
  CHECK(unscrew(-kPitch).status == Status::hit);
  for (const double off : {0.99, 1.01}) {
    // Flanks have a slope of 1, so that it jams once it is the gap off its way, or sooner by what its edges, which are
    // straight, lack from a circle.
    const Result jammed = unscrew(off * kPitch);
    const double expected = kGap / (0.01 * kPitch * kTurns);
    CAPTURE(off, jammed.lo, jammed.hi, expected);
    REQUIRE(jammed.status == Status::hit);
    CHECK(jammed.lo <= expected);
    CHECK(jammed.lo >= 0.85 * expected);
    CHECK(jammed.hi - jammed.lo < 1e-6);
  }
}

TEST_CASE("gears mesh with their backlash, and touch where one turns too fast, or both are too near") {
  constexpr uint32_t kTeeth[] = {20, 30};
  constexpr double kBacklash = 0.02;
  Scene scene;
  const MeshId gears[] = {addGear(scene, kTeeth[0], kBacklash / 2, 2), addGear(scene, kTeeth[1], kBacklash / 2, 1)};
  const auto mesh = [&](double nearer, double faster) {
    // A tooth of the first points into a gap of the second.
    Chain chain;
    chain.variables = 2;
    const double apart = (kTeeth[0] + kTeeth[1]) / 2.0 - nearer;
    chain.links = {{.joint = JointType::revolute, .axis = {0, 0, 1}, .variable = 0, .meshes = {{gears[0], {}}}},
                   {.parentFromJoint = at({apart, 0, 0}),
                    .joint = JointType::revolute,
                    .axis = {0, 0, -1},
                    .variable = 1,
                    .meshes = {{gears[1], at({}, kPi + kPi / kTeeth[1])}}}};
    chain.pairs = {{0, 1}};
    const double turned = 2 * 2 * kPi / kTeeth[0];  // two teeth
    const double from[] = {0, 0}, to[] = {turned, faster * turned * kTeeth[0] / kTeeth[1]};
    const ChainQuery query{.from = from, .to = to};
    return ChainSweeper(scene, chain).run({&query, 1})[0];
  };
  CHECK(mesh(0, 1).contact.status == Status::clear);
  CHECK(mesh(0.02, 1).contact.status == Status::clear);  // takes 2 0.02 tan 20 degrees of it
  CHECK(mesh(0.05, 1).contact.status == Status::overlap);
  for (const double faster : {0.98, 1.02}) {
    // Half the backlash is used up once the pitch circles are so far apart.
    const ChainResult jammed = mesh(0, faster);
    const double expected = kBacklash / 2 / (0.02 * 2 * 2 * kPi / kTeeth[0] * kTeeth[0] / 2);
    CAPTURE(faster, jammed.contact.lo, jammed.contact.hi, expected);
    REQUIRE(jammed.contact.status == Status::hit);
    CHECK(jammed.contact.lo >= 0.95 * expected);
    CHECK(jammed.contact.lo <= 1.25 * expected);  // chords of flanks are within them
    CHECK(jammed.link + jammed.otherLink == 1);
  }
}
