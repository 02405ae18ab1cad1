#include "contact/search_plan.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "exact/blocking.h"
#include "math/frame.h"
#include "math/rounding.h"
#include "query/course.h"

namespace radar {

namespace {

// Longer lengths are out of range anyway.
constexpr double kLongest = 1e38;

void stateDistance(gpu::StatedSearch& out, const Query& query, const Translation& motion) {
  const double way = motion.wayUntil(motion.end);
  out.exponent = way > 0 ? std::ilogb(way) : 0;
  const double mantissa = std::ldexp(way, -out.exponent);
  out.way = roundUp(mantissa);
  // A step's way has been rounded up.
  out.certain = motion.isStep ? roundDown((1 - 0x1p-48) * mantissa) : out.way;
  out.stopBefore = query.anyHit ? std::min(out.certain, roundDown(mantissa)) : -1;
  if (motion.isStep) out.perWay = way > 0 ? roundDown((1 - 0x1p-20) / mantissa) : -1;
}

}  // namespace

void SearchPlan::clear() {
  truncate(0);
}

void SearchPlan::truncate(uint32_t count) {
  if (count < stated.size()) excluded.resize(stated[count].firstExcluded);
  stated.resize(count);
  sweeps.resize(count);
  while (!groups.empty() && groups.back().first >= count) groups.pop_back();
}

bool SearchPlan::group(size_t query, uint32_t first) {
  if (first == count()) return false;
  groups.push_back({query, first, count() - first});
  return true;
}

const SearchPlan::Group& groupOf(std::span<const SearchPlan::Group> groups, uint32_t search) {
  return *std::prev(std::partition_point(groups.begin(), groups.end(),
                                         [&](const SearchPlan::Group& group) { return group.first <= search; }));
}

gpu::Sweep sweepOf(const Query& query, const Translation& motion, const Vector& direction, uint32_t result) {
  gpu::Sweep sweep{};
  std::copy(query.worldFromMesh.m.begin(), query.worldFromMesh.m.end(), sweep.pose);
  std::copy(direction.begin(), direction.end(), sweep.direction);
  sweep.directionLength = exact::length(direction);
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

Planned SearchPlan::add(const Query& query, uint32_t result, const Scene::Impl& scene, const ObjectTree& tree,
                        ObjectId object) {
  if (!tree.inRange()) return Planned::outOfRange;
  if (tree.nodes().empty()) return Planned::clear;
  const Translation motion = Course(query, scene).past(object);
  const Vector direction = scaledDirection(motion.direction);
  if (std::ilogb(largest(direction)) != 0) return Planned::outOfRange;
  const Mesh& mesh = scene.meshes[query.mesh];
  gpu::StatedSearch search{.mesh = query.mesh, .mask = query.mask};
  search.start = object == kNone ? tree.nodes()[0].link : gpu::kLinkLeaf | object;
  const std::array<Vector, 3> axes = axesAlong(direction);
  for (int k = 0; k < 3; ++k) {
    search.across[k] = static_cast<float>(axes[0][k]);
    search.upwards[k] = static_cast<float>(axes[1][k]);
    search.direction[k] = static_cast<float>(axes[2][k]);
  }
  stateDistance(search, query, motion);
  search.clearance = roundUp(std::min(query.clearance, kLongest));
  search.tolerance = roundUp(std::min(query.tolerance.value_or(kLongest), kLongest));
  if (query.ignoreLeaving && query.slack) search.slack = roundUp(std::min(2 * *query.slack, kLongest));
  // A contact that is certain wherever the slack moves a corner blocks. Twice the slack, since it may also tilt planes:
  // then the same holds for triangles in one plane (docs/exact.md, "Pairs that block"). By default the slack is at most
  // a sixteenth of either placement's error.
  if (query.ignoreLeaving && !query.slack) search.slackShare = 0.125f;
  search.firstExcluded = static_cast<uint32_t>(excluded.size());
  // Who is searched alone takes part.
  if (object == kNone) excluded.insert(excluded.end(), query.exclude.begin(), query.exclude.end());
  std::sort(excluded.begin() + search.firstExcluded, excluded.end());
  search.endExcluded = static_cast<uint32_t>(excluded.size());

  gpu::Sweep sweep = sweepOf(query, motion, direction, result);
  sweep.cpuDecides = query.clearance > 0 ? 1 : 0;
  if (query.ignoreLeaving) {
    sweep.ignoreLeaving = 1;
    sweep.isMirrored = exact::isMirroring(query.worldFromMesh) ? 1 : 0;
    sweep.slack = query.slack.value_or(-1);
    sweep.magnitude = placedMagnitude(mesh.farthest, query.worldFromMesh);
  }
  stated.push_back(search);
  sweeps.push_back(sweep);
  return Planned::added;
}

}  // namespace radar
