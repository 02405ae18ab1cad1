#include "contact/decode.h"

#include <algorithm>
#include <tuple>

#include <vulkan/vulkan_core.h>

#include "cpu/clearance.h"
#include "cpu/query_search.h"
#include "exact/blocking.h"
#include "exact/earliest_contact.h"

namespace radar {

UnresolvedPairs::UnresolvedPairs(std::span<const gpu::UnresolvedPair> pairs) {
  ordered_.reserve(pairs.size());
  for (const gpu::UnresolvedPair& pair : pairs) {
    if (pair.sensor != gpu::kNobody) ordered_.push_back(&pair);
  }
  const auto name = [](const gpu::UnresolvedPair* p) { return std::tie(p->sensor, p->object, p->triB, p->triA); };
  std::sort(ordered_.begin(), ordered_.end(), [&](const auto* p, const auto* q) { return name(p) < name(q); });
}

std::span<const gpu::UnresolvedPair* const> UnresolvedPairs::of(uint32_t sensor, const Result& found) const {
  if (found.flags != Flag::unresolved && found.status != Status::overlap) return {};
  const auto first =
      std::partition_point(ordered_.begin(), ordered_.end(), [&](const auto* pair) { return pair->sensor < sensor; });
  const auto end =
      std::partition_point(first, ordered_.end(), [&](const auto* pair) { return pair->sensor == sensor; });
  return {first, end};
}

namespace {

Transform poseOf(const gpu::UnresolvedPair& pair) {
  Transform worldFromObject;
  std::copy(std::begin(pair.pose), std::end(pair.pose), worldFromObject.m.begin());
  return worldFromObject;
}

exact::PlacedPair placedPair(const gpu::UnresolvedPair& pair, const Query& query) {
  const Transform worldFromObject = poseOf(pair);
  exact::PlacedPair placed;
  for (int i = 0; i < 3; ++i) {
    placed.a[i] = transformPoint(query.worldFromMesh, pair.a[i]);
    placed.b[i] = transformPoint(worldFromObject, pair.b[i]);
  }
  return placed;
}

// Considers a pair by the rule of a query that ignores what does not block.
void considerBlocking(const gpu::UnresolvedPair& pair, const exact::PlacedPair& inOrder,
                      const exact::PlacedPair& sorted, const Query& query, const exact::Course& course,
                      std::span<const Vector> farthest, exact::EarliestContact& earliest) {
  const Transform worldFromObject = poseOf(pair);
  const double slack = query.slack
                           ? *query.slack
                           : exact::defaultSlack(std::max(placedMagnitude(farthest[query.mesh], query.worldFromMesh),
                                                          placedMagnitude(farthest[pair.mesh], worldFromObject)));
  const exact::Mirrored mirrored{exact::isMirroring(query.worldFromMesh), exact::isMirroring(worldFromObject)};
  const exact::PairName name{pair.object, pair.triB, pair.triA};
  if (exact::arePressed(inOrder.a, inOrder.b, course, slack, mirrored)) {
    earliest.considerPressed(name, sorted);
  } else {
    earliest.consider(name, sorted, [&] { return exact::blocks(inOrder.a, inOrder.b, course, slack, mirrored); });
  }
}

Result decideClearance(std::span<const gpu::UnresolvedPair* const> pairs, const Query& query, const Motion& motion,
                       double tolerance) {
  cpu::ClearanceContact contact(query, motion, tolerance);
  contact.beginObject({}, motion);
  for (const gpu::UnresolvedPair* pair : pairs) {
    contact.consider({pair->object, pair->triB, pair->triA}, placedPair(*pair, query), 0);
    if (contact.isDecided()) break;
  }
  Result result = contact.first();
  if (result.status == Status::overlap) {
    // Only the CPU's search names the nearest pair.
    result = {};
    result.status = Status::overlap;
    result.detected = Detected::yes;
    result.t = result.lo = result.hi = result.fraction = 0;
  }
  result.tier = Tier::contact;
  return result;
}

}  // namespace

Result decideUnresolved(const Result& found, std::span<const gpu::UnresolvedPair* const> pairs, const Query& query,
                        const Motion& motion, double tolerance, std::span<const Vector> farthest) {
  if (query.clearance > 0) return decideClearance(pairs, query, motion, tolerance);
  exact::EarliestContact earliest(motion);
  for (const gpu::UnresolvedPair* pair : pairs) {
    const exact::PlacedPair inOrder = placedPair(*pair, query);
    // Sorted, so that the device's numbering of corners does not matter.
    exact::PlacedPair sorted = inOrder;
    std::sort(sorted.a.begin(), sorted.a.end());
    std::sort(sorted.b.begin(), sorted.b.end());
    if (query.ignoreLeaving) {
      considerBlocking(*pair, inOrder, sorted, query, exact::courseOf(motion), farthest, earliest);
    } else {
      earliest.consider({pair->object, pair->triB, pair->triA}, sorted);
    }
    if (query.anyHit && earliest.found()) break;
  }
  if (!earliest.found() && found.detected == Detected::yes) {
    throw Error("the contact search lost a certain contact", VK_ERROR_UNKNOWN);
  }
  Result result = earliest.answer(query.anyHit);
  result.tier = Tier::contact;
  return result;
}

Result clearAnswer() {
  Result result(Status::clear);
  result.tier = Tier::contact;
  return result;
}

namespace {

// Whether what a search found is its answer; else only the CPU can tell.
bool isSettled(const Query& query, double tolerance, const Result& found) {
  if (found.flags != 0 || found.status == Status::invalid) return false;
  if (query.clearance > 0) {
    // The CPU finds the nearest pair of triangles at the start.
    if (found.status == Status::overlap && found.object == kNone) return false;
    // What is certain on the device may have kept the search from other pairs.
    if (found.status == Status::undecided) return false;
    // In a bracket that rounding keeps wide, other pairs may begin than those that the CPU's search comes across.
    if (found.status == Status::hit && !query.anyHit && !(found.hi - found.lo <= tolerance)) return false;
  }
  // What meets at the start may cross, and then takes no part.
  const bool mayCross = found.status == Status::overlap || (query.anyHit && found.status == Status::hit);
  return !(query.skipOverlapping && mayCross);
}

std::optional<Merged> settledAnswer(const Query& query, double tolerance, std::span<const Result> searches) {
  const auto settled = [&](const Result& found) { return isSettled(query, tolerance, found); };
  if (query.anyHit) {
    // One contact settles it, whatever the other searches have found.
    for (const Result& found : searches) {
      if (settled(found) && found.status != Status::clear) return Merged{.first = found, .hits = {}};
    }
  }
  if (!std::all_of(searches.begin(), searches.end(), settled)) return std::nullopt;
  if (searches.size() == 1 && query.hits == 1) return Merged{.first = searches[0], .hits = {}};
  Merged answer = merged(searches, query.hits);
  return answer.isCertain ? std::optional(std::move(answer)) : std::nullopt;
}

}  // namespace

std::optional<Merged> certainAnswer(const Query& query, const Scene::Impl& scene, std::span<const Result> searches) {
  auto answer = settledAnswer(query, cpu::toleranceOf(query, scene.meshes[query.mesh]), searches);
  if (!answer || !isStep(query, scene) || query.motion) return answer;
  cpu::toDistances(answer->first, query.distance);
  for (Result& hit : answer->hits) cpu::toDistances(hit, query.distance);
  return answer;
}

}  // namespace radar
