// Cutters on rasters over plates and boxes along the axes, where many ways touch a face, an edge or a corner exactly.
#include <algorithm>
#include <cmath>

#include "cutter_kinds.h"
#include "support/catch.h"

using namespace radar;
using namespace radar::test;
using tools::Vec3;

namespace {

/// A rectangle, or what one sweeps, along the axes.
struct Span {
  Vec3 lo, hi;
};

/// How deep a cutter at the origin gets into what a rectangle sweeps that moves by -t d, d along an axis; below 0: how
/// much is missing. (Its points nearest to the axis are so at all of its heights.) `room`: the cutter is larger by
/// that.
Real depth(const CutterKind& kind, const Span& plate, const Vec3& d, Real t, Real room) {
  std::array<Real, 3> lo, hi;
  for (size_t k = 0; k < 3; ++k) {
    lo[k] = plate.lo[k] - std::max(d[k] * t, Real(0));
    hi[k] = plate.hi[k] - std::min(d[k] * t, Real(0));
  }
  const auto fromZero = [&](size_t k) { return std::max({lo[k], -hi[k], Real(0)}); };
  const Real out = std::max<Real>(std::hypot(fromZero(0), fromZero(1)) - room, 0);
  return std::min(
      {kind.radius - out, kind.length + room - lo[2], hi[2] + room - kind.height(std::min(out, kind.radius))});
}

/// The first t at which what grows along with t is 0 or more.
template <class Depth>
Real firstTime(const Depth& depth, Real end) {
  if (!(depth(end) >= 0)) return kNever;
  Real before = -1e-3L, after = end;
  for (int i = 0; i < 80; ++i) (depth((before + after) / 2) >= 0 ? after : before) = (before + after) / 2;
  return after;
}

/// A multiple of 1/4.
double quarters(Random& random, int from, int to) {
  return 0.25 * (from + static_cast<int>(random.below(static_cast<uint32_t>(to - from + 1))));
}

std::vector<Span> platesOf(Random& random) {
  Span box;
  for (size_t k = 0; k < 3; ++k) {
    box.lo[k] = quarters(random, -8, 4);
    box.hi[k] = box.lo[k] + quarters(random, 1, 8);
  }
  std::vector<Span> out;
  for (size_t k = 0; k < 3; ++k) {
    out.insert(out.end(), {box, box});
    out.back().lo[k] = box.hi[k];
    out[out.size() - 2].hi[k] = box.lo[k];
  }
  if (random.oneIn(2)) return {out[random.below(6)]};
  return out;
}

MeshId addPlates(Scene& scene, const std::vector<Span>& plates) {
  std::vector<float> corners;
  std::vector<uint32_t> faces;
  for (const Span& plate : plates) {
    const size_t across = plate.lo[0] == plate.hi[0] ? 0 : plate.lo[1] == plate.hi[1] ? 1 : 2;
    const auto first = static_cast<uint32_t>(corners.size() / 3);
    for (const uint32_t corner : {0, 1, 2, 1, 3, 2}) faces.push_back(first + corner);
    for (int corner = 0; corner < 4; ++corner) {
      Vec3 at = plate.lo;
      if (corner & 1) at[(across + 1) % 3] = plate.hi[(across + 1) % 3];
      if (corner & 2) at[(across + 2) % 3] = plate.hi[(across + 2) % 3];
      for (const double x : at) corners.push_back(static_cast<float>(x));
    }
  }
  return scene.addMesh(corners, faces);
}

}  // namespace

TEST_CASE("cutters on rasters pass plates and boxes by, and only what they touch to rounding is left open") {
  constexpr Real kRoom = 1e-6, kTiny = 1e-13;
  int hits = 0, clear = 0, overlaps = 0, grazes = 0, open = 0;
  for (uint64_t seed = 0; seed < 1500; ++seed) {
    Random random(seed);
    const double r = quarters(random, 4, 9);
    const CutterKind kind = cutterOf(static_cast<int>(seed % kCutterKinds), r, 0.25,
                                     std::atan(2 * quarters(random, 1, 4)), 0.25, 2 * r + quarters(random, 0, 16));
    const std::vector<Span> plates = platesOf(random);
    const tools::Rotation turn = seed % 3 == 0 ? random.rotation() : tools::kUpright;
    Scene scene;
    scene.addObject({addPlates(scene, plates), tools::makePose(turn, tools::kFull, {})});
    Query query{.mesh = scene.addCutter(kind.cutter)};
    for (int place = 0; place < 40; ++place) {
      Vec3 at{quarters(random, -14, 14), quarters(random, -14, 14), quarters(random, -40, 20)}, d = random.axis();
      query.worldFromMesh = tools::makePose(turn, tools::kFull, tools::turned(turn, at));
      query.direction = tools::turned(turn, d);
      query.distance = place % 8 == 0 ? 0.001 : quarters(random, 0, 40);
      CAPTURE(seed, place, kind.name, r, at[0], at[1], at[2], d[0], d[1], d[2], query.distance);
      const auto depthAt = [&](Real t, Real room) {
        Real most = -kNever;
        for (Span plate : plates) {
          for (size_t k = 0; k < 3; ++k) plate.lo[k] -= at[k], plate.hi[k] -= at[k];
          most = std::max(most, depth(kind, plate, d, t, room));
        }
        return most;
      };
      const auto firstWith = [&](Real room) {
        return firstTime([&](Real t) { return depthAt(t, room); }, query.distance);
      };
      const Result result = answer(scene, query);
      CAPTURE(result.lo, result.hi, double(firstWith(kRoom)), double(firstWith(0)), double(firstWith(-kRoom)));
      const Real atEnd = depthAt(query.distance, 0);
      const bool isExact = kind.angle == 0 && seed % 3 != 0;
      if (isExact) REQUIRE((atEnd < 0 || result.status != Status::clear));
      if (depthAt(query.distance, kRoom) < 0) {
        REQUIRE(result.status == Status::clear);
        ++clear;
        continue;
      }
      if (depthAt(0, -kRoom) >= 0) {
        REQUIRE(result.status == Status::overlap);
        ++overlaps;
        continue;
      }
      if (depthAt(query.distance, -kRoom) < 0 || depthAt(0, kRoom) >= 0) {
        ++grazes;
        open += result.status == Status::undecided;
        continue;
      }
      REQUIRE(result.status == Status::hit);
      // A graze before contact may widen the bracket as far back.
      REQUIRE(result.lo >= firstWith(kRoom));
      REQUIRE(result.hi <= firstWith(-kRoom));
      const Real tiny = isExact ? 0 : kTiny;
      REQUIRE(result.lo <= firstWith(-tiny) + kTiny);
      REQUIRE(result.hi >= firstWith(tiny) - kTiny);
      ++hits;
    }
  }
  CAPTURE(hits, clear, overlaps, grazes, open);
  CHECK(hits > 2000);
  CHECK(clear > 40000);
  CHECK(overlaps > 5000);
  CHECK(grazes > 1000);
}

TEST_CASE("a cutter that stands beside an edge in a plane along its side is clear") {
  Scene scene;
  scene.addObject({scene.addMesh(std::vector<float>{-2, 2, 3, 0.1f, 2, -2, 0.1f, 4, 3.5f}, oneTriangle())});
  const Query query{.mesh = scene.addCutter(ballCutter(2, 9)), .direction = {0, 0, 1}, .distance = 0.001};
  CHECK(answer(scene, query).status == Status::clear);
}
