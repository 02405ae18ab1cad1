// How near a sensor comes on its way, and when its last contact ends: the CPU's answers against brute force over all
// pairs of triangles, distances in long doubles, contacts in exact integers.
#include <algorithm>
#include <cmath>
#include <optional>

#include "brute_force.h"
#include "distances.h"
#include "exact/contact.h"
#include "radar/cpu_sweeper.h"
#include "scene_kinds.h"
#include "support/catch.h"
#include "support/seeds.h"

using namespace radar;
using soups::Random;
using tools::Vec3;

namespace {

using Real = long double;
// Where rounding of the former seems to find a bracket wrong.
using Fine = boost::multiprecision::cpp_bin_float_quad;

/// A pair of triangles on a query's way, relative to a corner of the sensor's.
template <class Number>
struct Passing {
  distances::Points<Number> a, b;
  distances::Point<Number> unit;
  Number end, size;
};

template <class Number>
Passing<Number> passingOf(const oracle::Corners& a, const oracle::Corners& b, const Vec3& direction, Number end) {
  using std::abs;
  Passing<Number> out{{}, {}, distances::pointOf<Number>(direction), end, 0};
  if (direction != Vec3{}) out.unit /= out.unit.stableNorm();
  for (size_t i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      out.a[i][k] = Number(a[i][size_t(k)]) - a[0][size_t(k)];
      out.b[i][k] = Number(b[i][size_t(k)]) - a[0][size_t(k)];
      out.size = std::max({out.size, Number(abs(out.a[i][k])), Number(abs(out.b[i][k]))});
    }
  }
  for (auto* t : {&out.a, &out.b}) {
    for (auto& p : *t) p /= out.size;
  }
  // Past this, they move apart.
  out.end = std::min(Number(16), Number(end / out.size));
  return out;
}

template <class Number>
Number leastOf(const Passing<Number>& pair) {
  return pair.size * distances::leastDistance(pair.a, pair.b, pair.unit, pair.end, 110);
}

/// Below every distance on the way.
Real roughly(const Passing<Real>& pair) {
  const auto middle = [](const distances::Points<Real>& t) { return distances::Point<Real>((t[0] + t[1] + t[2]) / 3); };
  const auto reach = [&](const distances::Points<Real>& t) {
    return std::max({(t[0] - middle(t)).norm(), (t[1] - middle(t)).norm(), (t[2] - middle(t)).norm()});
  };
  const distances::Point<Real> from = middle(pair.a), to = from + pair.end * pair.unit;
  return pair.size * (distances::fromSegment<Real>(middle(pair.b), from, to) - reach(pair.a) - reach(pair.b));
}

/// The last t at which they are within c; -1 if they never are.
Real lastWithin(const Passing<Real>& pair, Real c) {
  const auto isWithin = [&](Real t) { return distances::distanceAt(pair.a, pair.b, pair.unit, t) <= c / pair.size; };
  Real in = distances::nearestTime(pair.a, pair.b, pair.unit, pair.end, 110), out = pair.end;
  if (!isWithin(in)) return -1;
  if (isWithin(out)) return pair.size * out;
  for (int i = 0; i < 80; ++i) (isWithin((in + out) / 2) ? in : out) = (in + out) / 2;
  return pair.size * in;
}

/// Calls `visit` with the name, the corners and the direction of each pair that takes part.
template <class Visit>
void forEachPair(const Scene& scene, const Query& query, const std::vector<ObjectId>& skipped, const Visit& visit) {
  const MeshView sensor = scene.mesh(query.mesh);
  for (ObjectId id = 0; id < scene.objectLimit(); ++id) {
    if (!oracle::takesPart(scene, query, id)) continue;
    if (std::ranges::find(skipped, id) != skipped.end()) continue;
    const Object& object = scene.object(id);
    const MeshView mesh = scene.mesh(object.mesh);
    const Vec3 direction = oracle::directionPast(scene, query, id);
    for (uint32_t triB = 0; triB < mesh.indices.size() / 3; ++triB) {
      for (uint32_t triA = 0; triA < sensor.indices.size() / 3; ++triA) {
        visit(exact::PairName{id, triB, triA}, oracle::corners(sensor, query.worldFromMesh, triA),
              oracle::corners(mesh, object.worldFromMesh, triB), direction);
      }
    }
  }
}

struct Counts {
  int apart = 0, meeting = 0, out = 0, never = 0, stuck = 0, outOfClearance = 0;
};

/// World units of the sensor's way past an object.
template <class Number = Real>
Number wayPast(const Scene& scene, const Query& query, const Vec3& direction) {
  return oracle::isStep(scene, query) ? distances::pointOf<Number>(direction).stableNorm() : Number(query.distance);
}

void checkExit(const Scene& scene, const Query& query, const std::vector<ObjectId>& skipped, const Result& exit,
               Counts& counts) {
  const bool isStep = oracle::isStep(scene, query);
  const double end = query.motion ? 1 : query.distance;
  std::optional<oracle::Contact> last;
  bool isStuck = false;
  forEachPair(scene, query, skipped, [&](const exact::PairName& name, const auto& a, const auto& b, Vec3 direction) {
    const bool stands = direction == Vec3{};
    if (stands) direction = {1, 0, 0};
    const auto touching = oracle::contact(a, b, direction);
    if (!touching || touching->last.sign() < 0) return;
    const auto contactAt = [&](oracle::Fraction s) {
      if (s.sign() < 0) s = {0};
      return oracle::Contact{s, name.object, name.triB, name.triA, isStep};
    };
    if (stands ? touching->first.sign() > 0 : oracle::compareToTime(contactAt(touching->first), query, end) > 0) return;
    const oracle::Contact own = contactAt(stands ? oracle::Fraction{0} : touching->last);
    isStuck = isStuck || stands || oracle::compareToTime(own, query, end) >= 0;
    const int order = last ? oracle::compare(own.s, last->s) : 1;
    const bool isLess = last && name < exact::PairName{last->object, last->triB, last->triA};
    if (order > 0 || (order == 0 && isLess)) last = own;
  });
  if (!last) {
    REQUIRE(exit.status == Status::clear);
    ++counts.never;
    return;
  }
  REQUIRE(exit.status == Status::hit);
  REQUIRE(exit.t == exit.hi);
  if (isStuck) {
    REQUIRE(exit.lo == end);
    REQUIRE(exit.hi == end);
    ++counts.stuck;
    return;
  }
  CAPTURE(exit.lo, exit.hi, exit.object, exit.triA, exit.triB, last->object, last->triA, last->triB);
  REQUIRE(oracle::compareToTime(*last, query, exit.lo) >= 0);
  REQUIRE(oracle::compareToTime(*last, query, exit.hi) <= 0);
  REQUIRE(exit.hi - exit.lo <= 1e-14 * exit.hi + 1e-300);
  REQUIRE(exit.object == last->object);
  REQUIRE(exit.triB == last->triB);
  REQUIRE(exit.triA == last->triA);
  ++counts.out;
}

void checkClosest(const Scene& scene, const Query& query, const std::vector<ObjectId>& skipped, const Closest& found,
                  bool meets, Counts& counts) {
  if (meets) {
    REQUIRE(found.lo == 0);
    REQUIRE(found.hi == 0);
    ++counts.meeting;
    return;
  }
  Real least = INFINITY, size = 0, atNamed = INFINITY;
  forEachPair(scene, query, skipped, [&](const exact::PairName& name, const auto& a, const auto& b, const Vec3& d) {
    const Real whole = wayPast(scene, query, d);
    const Passing<Real> pair = passingOf(a, b, d, whole);
    const bool isNamed = name == exact::PairName{found.at.object, found.at.triB, found.at.triA};
    if (!isNamed && roughly(pair) > std::min<Real>(least, found.hi)) return;
    Real own = leastOf(pair);
    if (own < found.lo || isNamed) own = Real(leastOf(passingOf<Fine>(a, b, d, wayPast<Fine>(scene, query, d))));
    if (own < least) size = pair.size;
    least = std::min(least, own);
    if (!isNamed) return;
    const Real way = query.motion ? found.at.t * whole : Real(found.at.t);
    size = std::max(size, pair.size);
    atNamed = pair.size * distances::distanceAt(pair.a, pair.b, pair.unit, std::min<Real>(way / pair.size, pair.end));
  });
  CAPTURE(found.lo, found.hi, double(least), double(size), found.at.fraction);
  if (std::isinf(least)) {
    REQUIRE(std::isinf(found.lo));
    REQUIRE(found.at.object == kNone);
    return;
  }
  // That far the judge narrows times down.
  const Real room = 1e-21L * size;
  REQUIRE(found.lo <= least + room);
  REQUIRE(found.hi >= least - room);
  REQUIRE(found.hi - found.lo <= std::max(1e-13L * size, 1e-8L * least));
  REQUIRE(std::abs(atNamed - found.at.gap) <= 1e-12L * size);
  REQUIRE(atNamed <= found.hi + 1e-12L * size);
  ++counts.apart;
}

void checkExitWithin(const Scene& scene, const Query& query, const Result& exit, Counts& counts) {
  const Real end = query.motion ? 1 : query.distance;
  Real last = -1, room = 0;
  bool isOpen = false;
  forEachPair(scene, query, {}, [&](const exact::PairName&, const auto& a, const auto& b, const Vec3& d) {
    const Real whole = wayPast(scene, query, d), rate = whole > 0 ? end / whole : 0;
    const Passing<Real> pair = passingOf(a, b, d, whole);
    if (roughly(pair) > query.clearance) return;
    const Real slack = 1e-12L * (pair.size + Real(query.clearance));
    if (std::abs(leastOf(pair) - query.clearance) <= slack) isOpen = true;
    const Real own = lastWithin(pair, query.clearance);
    if (own < 0) return;
    // Beyond the pair's reach, or at the end.
    const Real t = pair.end * pair.size >= whole && own >= whole ? end : own * rate;
    if (t >= last) room = slack * rate;
    last = std::max(last, t);
  });
  CAPTURE(exit.lo, exit.hi, double(last), double(room), query.clearance);
  if (isOpen) return;
  if (last < 0) {
    REQUIRE(exit.status == Status::clear);
    return;
  }
  REQUIRE(exit.status == Status::hit);
  // Where it recedes slowly, rounding of the distance matters more.
  const Real loose = std::max(room, 1e-9L * last);
  REQUIRE(exit.lo <= last + room);
  REQUIRE(exit.hi >= last - room);
  REQUIRE(exit.lo >= last - 1e4L * loose);
  REQUIRE(exit.hi <= last + 1e4L * loose);
  ++counts.outOfClearance;
}

void check(const Scene& scene, Query query, Counts& counts) {
  query.ignoreLeaving = query.anyHit = false;
  query.clearance = 0;
  query.hits = 1;
  query.closest = query.exit = true;
  const Answers answers = CpuSweeper(scene, 1).run({&query, 1});
  const Listed& listed = answers.lists.at(0);
  checkExit(scene, query, listed.overlapping, *listed.exit, counts);
  const bool meets = answers.results[0].status != Status::clear;
  checkClosest(scene, query, listed.overlapping, *listed.closest, meets, counts);
  // Within a clearance that something keeps, by far, on a part of the way.
  if (meets || !(listed.closest->hi < 0x1p500 && listed.closest->hi > 0x1p-500)) return;
  query.clearance = 1.5 * listed.closest->hi;
  query.skipOverlapping = query.closest = false;
  query.slack.reset();
  checkExitWithin(scene, query, *CpuSweeper(scene, 1).run({&query, 1}).lists.at(0).exit, counts);
}

}  // namespace

TEST_CASE("scenes of all kinds have the closest approach and the last contact that brute force finds") {
  Counts counts;
  for (const kinds::Kind& kind : kinds::all()) {
    for (const uint32_t seed : test::seeds({1, 2})) {
      Random random(seed);
      test::Case of;
      kind.make(random, of);
      for (size_t q = 0; q < of.queries.size(); ++q) {
        INFO(kind.name << ", seed " << seed << ", query " << q);
        check(of.scene, of.queries[q], counts);
      }
    }
  }
  CAPTURE(counts.apart, counts.meeting, counts.out, counts.never, counts.stuck, counts.outOfClearance);
  CHECK(counts.apart > 150);
  CHECK(counts.meeting > 250);
  CHECK(counts.out > 180);
  CHECK(counts.never > 150);
  CHECK(counts.stuck > 40);
  CHECK(counts.outOfClearance > 60);
}
