#include "contact/search_plan.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>

#include "exact/blocking.h"
#include "math/frame.h"
#include "math/rounding.h"
#include "query/course.h"
#include "scene/parallel.h"

namespace radar {

namespace {

// Longer lengths are out of range anyway.
constexpr double kLongest = 1e38;
// Searches that take as long to state as a thread to wake.
constexpr size_t kWorthThread = 1024;

void stateDistance(gpu::StatedSearch& out, const Query& query, const Translation& motion) {
  const double way = motion.wayUntil(motion.end);
  const bool isUsual = way >= 0x1p-1000 && way <= 0x1p1000;
  out.exponent = isUsual ? exponentOf(way) : way > 0 ? std::ilogb(way) : 0;
  const double mantissa = isUsual ? powerOfTwo(-out.exponent) * way : std::ldexp(way, -out.exponent);
  out.way = roundUp(mantissa);
  // A step's way has been rounded up.
  out.certain = motion.isStep ? roundDown((1 - 0x1p-48) * mantissa) : out.way;
  out.stopBefore = query.anyHit ? std::min(out.certain, roundDown(mantissa)) : -1;
  if (motion.isStep) out.perWay = way > 0 ? roundDown((1 - 0x1p-20) / mantissa) : -1;
}

}  // namespace

const SearchGroup& groupOf(std::span<const SearchGroup> groups, uint32_t search) {
  return *std::prev(std::partition_point(groups.begin(), groups.end(),
                                         [&](const SearchGroup& group) { return group.first <= search; }));
}

gpu::Sweep sweepOf(const Query& query, const Translation& motion, uint32_t result) {
  // That of a sweep is scaled already.
  const Vector direction = motion.isStep ? scaledDirection(motion.direction) : motion.direction;
  gpu::Sweep sweep{};
  std::copy(query.worldFromMesh.m.begin(), query.worldFromMesh.m.end(), sweep.pose);
  std::copy(direction.begin(), direction.end(), sweep.direction);
  sweep.directionLength = motion.isStep ? exact::length(direction) : motion.length;
  sweep.distance = motion.end;
  sweep.perParameter = sweep.directionLength;
  if (motion.isStep) {
    sweep.perParameter = largest(direction) / largest(motion.direction);
    std::copy(motion.drift.begin(), motion.drift.end(), sweep.drift);
  }
  sweep.anyHit = query.anyHit ? 1 : 0;
  sweep.result = result;
  return sweep;
}

namespace {

// Without excluded objects.
Planned stateSearch(const Query& query, uint32_t result, const Scene::Impl& scene, ObjectId object,
                    gpu::StatedSearch& search, gpu::Sweep& sweep) {
  const Translation motion = Course(query, scene).past(object);
  sweep = sweepOf(query, motion, result);
  const Vector direction{sweep.direction[0], sweep.direction[1], sweep.direction[2]};
  if (const double size = largest(direction); !(size >= 1 && size < 2)) return Planned::outOfRange;
  search = {.mesh = query.mesh, .mask = query.mask};
  search.start = object == kNone ? gpu::kWholeTree : gpu::kLinkLeaf | object;
  const std::array<Vector, 3> axes = axesAlongUnit(motion.unit);
  for (int k = 0; k < 3; ++k) {
    search.across[k] = static_cast<float>(axes[0][k]);
    search.upwards[k] = static_cast<float>(axes[1][k]);
    search.direction[k] = static_cast<float>(axes[2][k]);
  }
  stateDistance(search, query, motion);
  search.clearance = roundUp(std::min(query.clearance, kLongest));
  search.tolerance = roundUp(std::min(query.tolerance.value_or(kLongest), kLongest));
  sweep.cpuDecides = query.clearance > 0 ? 1 : 0;
  if (!query.ignoreLeaving) return Planned::added;
  if (query.slack) search.slack = roundUp(std::min(2 * *query.slack, kLongest));
  // A contact that is certain wherever the slack moves a corner blocks. Twice the slack, since it may also tilt planes:
  // then the same holds for triangles in one plane (docs/exact.md, "Pairs that block"). By default the slack is at most
  // a sixteenth of either placement's error.
  if (!query.slack) search.slackShare = 0.125f;
  sweep.ignoreLeaving = 1;
  sweep.isMirrored = exact::isMirroring(query.worldFromMesh) ? 1 : 0;
  sweep.slack = query.slack.value_or(-1);
  sweep.magnitude = placedMagnitude(scene.meshes[query.mesh].farthest, query.worldFromMesh);
  return Planned::added;
}

// In ascending order. Returns where they begin and end.
std::pair<uint32_t, uint32_t> addExcluded(std::vector<uint32_t>& to, const Query& query, ObjectId object) {
  const size_t first = to.size();
  // Who is searched alone takes part.
  if (object == kNone) to.insert(to.end(), query.exclude.begin(), query.exclude.end());
  std::sort(to.begin() + static_cast<ptrdiff_t>(first), to.end());
  return {static_cast<uint32_t>(first), static_cast<uint32_t>(to.size())};
}

}  // namespace

Planned SearchPlan::add(const Query& query, uint32_t result, const Scene::Impl& scene, const ObjectTree& tree,
                        ObjectId object) {
  if (!tree.inRange()) return Planned::outOfRange;
  if (tree.nodes().empty()) return Planned::clear;
  gpu::StatedSearch search{};
  gpu::Sweep sweep{};
  const Planned planned = stateSearch(query, result, scene, object, search, sweep);
  if (planned != Planned::added) return planned;
  std::tie(search.firstExcluded, search.endExcluded) = addExcluded(excluded, query, object);
  stated.push_back(search);
  sweeps.push_back(sweep);
  return Planned::added;
}

void SearchPlan::clear() {
  stated.clear();
  sweeps.clear();
  excluded.clear();
  groups.clear();
}

bool SearchPlan::group(size_t query, uint32_t first) {
  if (first == count()) return false;
  groups.push_back({query, first, count() - first});
  return true;
}

SearchSource SearchPlan::source() const {
  const auto hasClearance = [](const gpu::StatedSearch& search) { return search.clearance > 0; };
  return {count(), excluded, std::ranges::any_of(sweeps, &gpu::Sweep::ignoreLeaving),
          std::ranges::any_of(stated, hasClearance), [this](gpu::StatedSearch* to, gpu::Sweep* sweepsTo) {
            std::ranges::copy(stated, to);
            std::ranges::copy(sweeps, sweepsTo);
          }};
}

SearchNeeds::SearchNeeds(const Query& query, const Scene::Impl& scene)
    : route(routeOf(query, scene, true)),
      ignoresLeaving(query.ignoreLeaving),
      hasClearance(query.clearance > 0),
      excludes(!query.exclude.empty()) {}

void SearchList::clear() {
  searches_.clear();
  groups_.clear();
  excluded_.clear();
  ignoresLeaving_ = hasClearances_ = false;
}

void SearchList::reserve(size_t searches) {
  searches_.reserve(searches);
  groups_.reserve(searches);
}

void SearchList::add(std::span<const Query> queries, size_t query, const SearchNeeds& needs,
                     std::span<const ObjectId> objects) {
  ignoresLeaving_ |= needs.ignoresLeaving;
  hasClearances_ |= needs.hasClearance;
  groups_.push_back({query, count(), static_cast<uint32_t>(objects.size())});
  const auto [first, end] = needs.excludes ? addExcluded(excluded_, queries[query], objects[0]) : std::pair{0u, 0u};
  for (const ObjectId object : objects) searches_.push_back({query, object, first, end});
}

SearchSource SearchList::source(const Of& of) {
  of_ = of;
  return {count(), excluded_, ignoresLeaving_, hasClearances_,
          [this](gpu::StatedSearch* stated, gpu::Sweep* sweeps) { write(stated, sweeps); }};
}

void SearchList::write(gpu::StatedSearch* stated, gpu::Sweep* sweeps) const {
  parallelFor(count(), kWorthThread, of_.threads, [&](unsigned, size_t from, size_t to) {
    for (size_t i = from; i < to; ++i) {
      const Listed& listed = searches_[i];
      gpu::StatedSearch search;
      gpu::Sweep sweep;
      if (stateSearch(of_.queries[listed.query], static_cast<uint32_t>(i), *of_.scene, listed.object, search, sweep) !=
          Planned::added) {
        search = {.start = gpu::kNobody, .flags = gpu::kSearchOutOfRange};
      }
      search.firstExcluded = listed.firstExcluded;
      search.endExcluded = listed.endExcluded;
      stated[i] = search;
      sweeps[i] = sweep;
    }
  });
}

}  // namespace radar
