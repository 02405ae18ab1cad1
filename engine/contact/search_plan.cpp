#include "contact/search_plan.h"

#include <algorithm>
#include <cmath>
#include <iterator>
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

// encode.comp finds it.
constexpr double kByDevice = -1;

// How a search's sensor moves past what it may meet.
struct Way {
  Vector direction;  ///< scaled as Translation's of a sweep
  double end;        ///< t
  double length;     ///< until then, world units, rounded up
  bool isStep = false;
  double perParameter = kByDevice;  ///< t per `direction`
  Vector drift{};                   ///< step: the object's displacement
};

Way wayOf(const Query& query, const Scene::Impl& scene, ObjectId object) {
  if (!isStep(query, scene)) return {scaledDirection(query.direction), query.distance, query.distance};
  const Translation motion = Course(query, scene).past(object);
  const Vector direction = scaledDirection(motion.direction);
  return {direction,   motion.end, motion.wayUntil(motion.end), true, largest(direction) / largest(motion.direction),
          motion.drift};
}

// Every member, each once, since `to` may be slow memory.
void stateSweep(gpu::Sweep& to, const Query& query, const Way& way, uint32_t result, const Scene::Impl& scene) {
  std::copy(query.worldFromMesh.m.begin(), query.worldFromMesh.m.end(), to.pose);
  std::copy(way.direction.begin(), way.direction.end(), to.direction);
  to.directionLength = kByDevice;
  to.distance = way.end;
  to.anyHit = query.anyHit ? 1 : 0;
  to.result = result;
  to.scale = to.start = 0;
  const bool ignores = query.ignoreLeaving;
  to.ignoreLeaving = ignores ? 1 : 0;
  to.isMirrored = ignores && exact::isMirroring(query.worldFromMesh) ? 1 : 0;
  to.cpuDecides = query.clearance > 0 ? 1 : 0;
  to.stepPerUnit = 0;
  to.slack = ignores ? query.slack.value_or(-1) : 0;
  to.magnitude = ignores ? placedMagnitude(scene.meshes[query.mesh].farthest, query.worldFromMesh) : 0;
  to.perParameter = way.perParameter;
  std::copy(way.drift.begin(), way.drift.end(), to.drift);
}

void stateDistance(gpu::StatedSearch& out, const Query& query, const Way& way) {
  const bool isUsual = way.length >= 0x1p-1000 && way.length <= 0x1p1000;
  out.exponent = isUsual ? exponentOf(way.length) : way.length > 0 ? std::ilogb(way.length) : 0;
  const double mantissa = isUsual ? powerOfTwo(-out.exponent) * way.length : std::ldexp(way.length, -out.exponent);
  out.way = roundUp(mantissa);
  // A step's way has been rounded up.
  out.certain = way.isStep ? roundDown((1 - 0x1p-48) * mantissa) : out.way;
  out.stopBefore = query.anyHit ? std::min(out.certain, roundDown(mantissa)) : -1;
  if (way.isStep) out.perWay = way.length > 0 ? roundDown((1 - 0x1p-20) / mantissa) : -1;
}

}  // namespace

const SearchGroup& groupOf(std::span<const SearchGroup> groups, uint32_t search) {
  return *std::prev(std::partition_point(groups.begin(), groups.end(),
                                         [&](const SearchGroup& group) { return group.first <= search; }));
}

gpu::Sweep sweepOf(const Query& query, const Translation& motion, const Scene::Impl& scene) {
  gpu::Sweep sweep{};
  stateSweep(sweep, query, {.direction = motion.direction, .end = motion.end, .length = motion.end}, 0, scene);
  sweep.directionLength = sweep.perParameter = motion.length;
  return sweep;
}

namespace {

using Excluded = std::pair<uint32_t, uint32_t>;  // where they begin and end

Planned stateSearch(const Query& query, uint32_t result, const Scene::Impl& scene, ObjectId object,
                    const Excluded& excluded, gpu::StatedSearch& search, gpu::Sweep& sweep) {
  const Way way = wayOf(query, scene, object);
  stateSweep(sweep, query, way, result, scene);  // out of range, too: the answer says so
  if (const double size = largest(way.direction); !(size >= 1 && size < 2)) return Planned::outOfRange;
  gpu::StatedSearch stated{.mesh = query.mesh,
                           .mask = query.mask,
                           .firstExcluded = excluded.first,
                           .endExcluded = excluded.second,
                           .start = object == kNone ? gpu::kWholeTree : gpu::kLinkLeaf | object};
  stateDistance(stated, query, way);
  stated.clearance = roundUp(std::min(query.clearance, kLongest));
  stated.tolerance = roundUp(std::min(query.tolerance.value_or(kLongest), kLongest));
  // A contact that is certain wherever the slack moves a corner blocks. Twice the slack, since it may also tilt planes:
  // then the same holds for triangles in one plane (docs/exact.md, "Pairs that block"). By default the slack is at most
  // a sixteenth of either placement's error.
  if (query.ignoreLeaving && query.slack) stated.slack = roundUp(std::min(2 * *query.slack, kLongest));
  if (query.ignoreLeaving && !query.slack) stated.slackShare = 0.125f;
  search = stated;
  return Planned::added;
}

// In ascending order.
Excluded addExcluded(std::vector<uint32_t>& to, const Query& query, ObjectId object) {
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
  const Planned planned =
      stateSearch(query, result, scene, object, addExcluded(excluded, query, object), search, sweep);
  if (planned != Planned::added) return planned;
  // No CPU decides what encode.comp may leave to it.
  sweep.directionLength = exact::length({sweep.direction[0], sweep.direction[1], sweep.direction[2]});
  if (sweep.perParameter < 0) sweep.perParameter = sweep.directionLength;
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
      const Planned planned =
          stateSearch(of_.queries[listed.query], static_cast<uint32_t>(i), *of_.scene, listed.object,
                      {listed.firstExcluded, listed.endExcluded}, stated[i], sweeps[i]);
      if (planned != Planned::added) stated[i] = {.start = gpu::kNobody, .flags = gpu::kSearchOutOfRange};
    }
  });
}

}  // namespace radar
