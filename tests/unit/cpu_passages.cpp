// How near a sensor comes on its way, and when its last contact ends: the CPU's answers against brute force over all
// pairs of triangles. A plane between two triangles proves that they stay apart; contacts are found in exact integers.
#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>

#include "brute_force.h"
#include "distances.h"
#include "exact/contact.h"
#include "radar/cpu_sweeper.h"
#include "scene_kinds.h"
#include "support/catch.h"
#include "support/seeds.h"
#include "workloads/vectors.h"

using namespace radar;
using soups::Random;
using tools::Vec3;

namespace {

using Real = long double;
// Where rounding of the former proves too little, as of edges that slide along each other at a distance of 1e-15.
using Fine = boost::multiprecision::cpp_bin_float_oct;

/// As a share of a pair's size: contacts of nearer ones are looked for exactly.
constexpr Real kNearlyTouching = 1e-6L;
/// That far the judge narrows times down.
const Fine kRoom = 1e-21L;

/// A pair of triangles on a query's way, relative to a corner of the sensor's.
template <class Number>
struct Passing {
  distances::Points<Number> a, b;
  distances::Point<Number> unit;
  Number start, end, size;

  distances::Point<Number> gapAt(const Number& t) const { return distances::gapAt(a, b, unit, t); }

  /// Below every distance from `start` to `end`: how far planes across n keep them apart, less what rounding adds.
  Number apartAlong(const distances::Point<Number>& n) const {
    const Number low = std::min({n.dot(b[0]), n.dot(b[1]), n.dot(b[2])});
    const Number high = std::max({n.dot(a[0]), n.dot(a[1]), n.dot(a[2])}), speed = n.dot(unit);
    const Number least = low - high - (speed > 0 ? Number(speed * end) : Number(speed * start));
    const Number length = n.norm();
    // Squares of less underflow.
    if (!(length > Number(1e-2000L))) return 0;
    // Halves of epsilon: 2 of a coordinate and 3 of a product, times lengths below 1.8, on both sides; up to 20 of the
    // way's length and direction; those of sum and quotient.
    return least / length - (32 + 16 * end) * std::numeric_limits<Number>::epsilon();
  }
};

/// From `start` to `end` in world units.
template <class Number>
Passing<Number> passingOf(const oracle::Corners& a, const oracle::Corners& b, const Vec3& direction, Number start,
                          Number end) {
  using std::abs;
  Passing<Number> out{{}, {}, distances::pointOf<Number>(direction), start, end, 0};
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
  out.start = std::min(out.end, Number(start / out.size));
  return out;
}

/// On the least distance of a pair on its way.
template <class Number>
struct Bounds {
  Number lo = 0, hi = INFINITY;
  Number t;  ///< where it is `hi`
};

/// Halves the way until the distance is proved to stay above `proved` or is at most `seen`, from the time `t` on.
template <class Number>
Bounds<Number> boundsOf(const Passing<Number>& pair, const Number& proved, const Number& seen, Number t) {
  Bounds<Number> out;
  Number left = pair.start, right = pair.end;
  std::optional<distances::Point<Number>> falling, rising;
  for (int i = 0; i < 200; ++i) {
    const distances::Point<Number> gap = pair.gapAt(t);
    const Number distance = gap.norm();
    if (distance < out.hi) {
      out.hi = distance;
      out.t = t;
    }
    out.lo = std::max(out.lo, pair.apartAlong(gap));
    const bool isFalling = gap.dot(pair.unit) > 0;
    (isFalling ? left : right) = t;
    (isFalling ? falling : rising) = gap;
    // A plane along the way keeps them as far apart as they ever are.
    if (falling && rising) {
      const Number fall = falling->dot(pair.unit), rise = rising->dot(pair.unit);
      out.lo = std::max(out.lo, pair.apartAlong(fall * *rising - rise * *falling));
    }
    if (out.lo > proved || out.hi <= seen) break;
    t = !falling ? left : !rising ? right : Number((left + right) / 2);
    if (falling && rising ? !(left < t && t < right) : left == right) break;
  }
  return out;
}

template <class Number>
Bounds<Number> boundsOf(const Passing<Number>& pair, const Number& proved, const Number& seen) {
  const Number level = (pair.b[0] + pair.b[1] + pair.b[2] - pair.a[0] - pair.a[1] - pair.a[2]).dot(pair.unit) / 3;
  return boundsOf(pair, proved, seen, std::min(std::max(level, pair.start), pair.end));
}

/// Whether they are proved to stay that far apart.
template <class Number>
bool stayApart(const Passing<Number>& pair, Number far) {
  far /= pair.size;
  if constexpr (std::is_same_v<Number, Fine>) far -= kRoom;
  return boundsOf(pair, far, far).lo >= far;
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

/// From the answer's exit on, if it has one: what stays apart from there on is not in contact last, or the answer is
/// wrong and nothing is from there on.
Passing<Real> passingFrom(const Scene& scene, const Query& query, const oracle::Corners& a, const oracle::Corners& b,
                          const Vec3& direction, const Result& exit) {
  const Real whole = wayPast(scene, query, direction), end = query.motion ? 1 : query.distance;
  return passingOf<Real>(a, b, direction, exit.status == Status::hit && end > 0 ? exit.lo / end * whole : 0, whole);
}

void checkExit(const Scene& scene, const Query& query, const std::vector<ObjectId>& skipped, const Result& exit,
               Counts& counts) {
  const bool isStep = oracle::isStep(scene, query);
  const double end = query.motion ? 1 : query.distance;
  std::optional<oracle::Contact> last;
  bool isStuck = false;
  forEachPair(scene, query, skipped, [&](const exact::PairName& name, const auto& a, const auto& b, Vec3 direction) {
    const Passing<Real> pair = passingFrom(scene, query, a, b, direction, exit);
    if (boundsOf<Real>(pair, 0, kNearlyTouching).lo > 0) return;
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
  std::optional<Real> atNamed;
  Real size = 0;
  bool isAny = false;
  forEachPair(scene, query, skipped, [&](const exact::PairName& name, const auto& a, const auto& b, const Vec3& d) {
    isAny = true;
    const Passing<Real> pair = passingOf<Real>(a, b, d, 0, wayPast(scene, query, d));
    const bool isNamed = name == exact::PairName{found.at.object, found.at.triB, found.at.triA};
    const bool isProved = stayApart<Real>(pair, found.lo);
    if (isProved && !isNamed) return;
    const Fine whole = wayPast<Fine>(scene, query, d);
    const Passing<Fine> fine = passingOf<Fine>(a, b, d, 0, whole);
    CAPTURE(found.lo, found.hi, double(pair.size), found.at.fraction);
    if (!isProved) REQUIRE(stayApart<Fine>(fine, found.lo));
    if (!isNamed) return;
    size = pair.size;
    const Fine way = (query.motion ? Fine(found.at.t * whole) : Fine(found.at.t)) / fine.size;
    const Fine t = std::max(Fine(0), std::min(way, fine.end)), most = Fine(found.hi) / fine.size + kRoom;
    atNamed = Real(fine.size * fine.gapAt(t).norm());
    REQUIRE(boundsOf<Fine>(fine, most, most, t).hi <= most);
  });
  if (!isAny) {
    REQUIRE(std::isinf(found.lo));
    REQUIRE(found.at.object == kNone);
    return;
  }
  REQUIRE(atNamed);
  CAPTURE(found.lo, found.hi, double(*atNamed), double(size), found.at.fraction);
  // A pair's bracket, and 8 of its widths below that are not looked for.
  REQUIRE(found.hi - found.lo <= std::max(1e-13L * size, 9 * 0x1p-27L * found.hi));
  REQUIRE(std::abs(*atNamed - found.at.gap) <= 1e-12L * size);
  REQUIRE(*atNamed <= found.hi + 1e-12L * size);
  ++counts.apart;
}

/// Within a clearance that something keeps by far.
void checkExitWithin(const Scene& scene, const Query& query, const Result& exit, Counts& counts) {
  const double end = query.motion ? 1 : query.distance, c = query.clearance;
  const Real longest = tools::boundsOf(scene.mesh(query.mesh), query.worldFromMesh).longest();
  const Real usual = 1e-6L * std::max(longest, Real(c)),
             tolerance = std::min(Real(query.tolerance.value_or(usual)), usual);
  std::optional<Real> width;
  bool isOpen = false;
  forEachPair(scene, query, {}, [&](const exact::PairName& name, const auto& a, const auto& b, const Vec3& d) {
    CAPTURE(exit.lo, exit.hi, c);
    const auto from = [&]<class Number>(Number t) {
      const Number whole = wayPast<Number>(scene, query, d);
      return passingOf<Number>(a, b, d, end > 0 ? Number(t / end * whole) : Number(0), whole);
    };
    // What passes at the clearance, to rounding, may widen the bracket, or leave it open.
    const Passing<Real> pair = from(Real(0));
    const Real slack = 1e-12L * (pair.size + c), outside = (c + slack) / pair.size, inside = (c - slack) / pair.size;
    const Bounds<Real> least = boundsOf(pair, outside, inside);
    isOpen = isOpen || !(least.lo > outside || least.hi <= inside);
    if (exit.status != Status::hit) return;
    if (exit.hi < end && !stayApart<Real>(from(Real(exit.hi)), c)) REQUIRE(stayApart<Fine>(from(Fine(exit.hi)), c));
    if (name != exact::PairName{exit.object, exit.triB, exit.triA}) return;
    const Passing<Fine> atLo = from(Fine(exit.lo));
    const Fine most = c / atLo.size + kRoom;
    REQUIRE(boundsOf(atLo, most, most, atLo.start).hi <= most);
    const Real whole = wayPast(scene, query, d), rate = whole > 0 ? end / whole : 0;
    width = std::max(1e-5L * exit.hi, std::max(tolerance, 1e-8L * (pair.size + c)) * rate);
  });
  CAPTURE(exit.lo, exit.hi, c);
  if (exit.status != Status::hit) {
    REQUIRE(exit.status == Status::undecided);
    REQUIRE(isOpen);
    return;
  }
  REQUIRE(exit.t == exit.hi);
  REQUIRE(width);
  REQUIRE((isOpen || exit.hi - exit.lo <= *width));
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
