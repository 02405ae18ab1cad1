#include "sweep/contact_decode.h"

#include <algorithm>
#include <cmath>

#include "sweep/contact_point.h"
#include "sweep/exact_pairs.h"

namespace radar {

namespace {

PairName nameOf(const gpu::Contender& c, const Query& query, const Scene::Impl& scene) {
  const Mesh& b = scene.meshes[scene.objects[c.object].object.mesh];
  return {c.object, b.clusters.order[c.slotB], scene.meshes[query.mesh].clusters.order[c.slotA]};
}

// The corners of the two parts that attain a contact; what a part lacks repeats its first. Equal features compare
// equal.
std::array<Vector, 6> partsOf(const PlacedPair& pair, uint32_t feature) {
  const auto& [a, b] = pair;
  if (feature < 3) return {a[feature], a[feature], a[feature], b[0], b[1], b[2]};
  if (feature < gpu::kFeatureEdges) return {a[0], a[1], a[2], b[feature - 3], b[feature - 3], b[feature - 3]};
  const uint32_t i = (feature - gpu::kFeatureEdges) / 3, j = (feature - gpu::kFeatureEdges) % 3;
  return {a[kEdgeFrom[i]], a[kEdgeTo[i]], a[kEdgeFrom[i]], b[kEdgeFrom[j]], b[kEdgeTo[j]], b[kEdgeFrom[j]]};
}

// Whether the device's word stands: every contender surely meets, first where the same two features touch, before D.
bool settled(const Search& search, const Query& query, const Scene::Impl& scene) {
  const gpu::Contender& first = search.contenders[0];
  if ((first.flags & gpu::kContenderSharp) == 0) return false;
  if ((first.at + first.error) * lengthOf(scaledDirection(query.direction)) * (1 + 8 * kDoubleUnit) >= query.distance)
    return false;
  if (search.contenders.size() == 1) return true;
  const auto parts = partsOf(placedPair(nameOf(first, query, scene), query, scene), first.flags & 0xff);
  return std::all_of(search.contenders.begin() + 1, search.contenders.end(), [&](const gpu::Contender& c) {
    return (c.flags & gpu::kContenderSharp) != 0 && c.at == first.at &&
           partsOf(placedPair(nameOf(c, query, scene), query, scene), c.flags & 0xff) == parts;
  });
}

// Within D or not: what the device is certain of needs no pair.
Result decision(std::span<const gpu::Contender> contenders, const gpu::State& state, const Query& query,
                const Scene::Impl& scene, uint64_t& cpuPairs) {
  bool hit = state.hi < query.distance;
  ExactPairs exact(query, scene);
  for (size_t i = 0; i < contenders.size() && !hit; ++i) {
    exact.consider(nameOf(contenders[i], query, scene));
    ++cpuPairs;
    hit = exact.found();
  }
  Result result;
  result.tier = Tier::contact;
  result.status = hit ? Status::hit : Status::clear;
  if (!hit) return result;
  result.detected = Detected::yes;
  result.lo = 0;
  result.hi = std::min<double>(state.hi, query.distance);
  return result;
}

}  // namespace

Result decodeContact(const Search& found, const Query& query, const Scene::Impl& scene, uint64_t& cpuPairs) {
  // What was kept before the first certain contact was met may begin beyond it.
  const double length = lengthOf(scaledDirection(query.direction));
  double limit = found.state.hi;
  for (const gpu::Contender& c : found.contenders) {
    if ((c.flags & gpu::kContenderMeets) == 0) continue;
    limit = std::min(limit, std::max(c.at + c.error, 0.0) * length * (1 + 8 * kDoubleUnit));
  }
  std::vector<gpu::Contender> kept;
  for (const gpu::Contender& c : found.contenders) {
    if (c.low <= limit) kept.push_back(c);
  }
  if (query.decide) return decision(kept, found.state, query, scene, cpuPairs);
  const Search search{found.state, kept};
  Result result;
  result.tier = Tier::contact;
  result.status = Status::clear;
  if (search.contenders.empty()) {
    if (found.state.hi < query.distance) throw Error("the contact search lost what it met", VK_ERROR_UNKNOWN);
    return result;
  }

  ExactPairs exact(query, scene);
  if (settled(search, query, scene)) {
    // The numbers come from the same arithmetic as where pairs are open, so that they do not depend on what was culled.
    PairName least = nameOf(search.contenders[0], query, scene);
    for (const gpu::Contender& c : search.contenders) least = std::min(least, nameOf(c, query, scene));
    exact.consider(least);
  } else {
    for (const gpu::Contender& c : search.contenders) exact.consider(nameOf(c, query, scene));
    cpuPairs += search.contenders.size();
  }
  if (exact.found()) {
    exact.tell(result);
  } else if (found.state.hi < query.distance) {
    throw Error("the contact search lost what it met", VK_ERROR_UNKNOWN);
  }
  return result;
}

}  // namespace radar
