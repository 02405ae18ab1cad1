#include "contact/decode.h"

#include <algorithm>
#include <tuple>

#include "contact/exact_pairs.h"

namespace radar {

UnresolvedPairs::UnresolvedPairs(std::span<const gpu::UnresolvedPair> pairs) {
  ordered_.reserve(pairs.size());
  for (const gpu::UnresolvedPair& pair : pairs) {
    if (pair.sensor != gpu::kNobody) ordered_.push_back(&pair);
  }
  const auto name = [](const gpu::UnresolvedPair* p) { return std::tie(p->sensor, p->object, p->triB, p->triA); };
  std::sort(ordered_.begin(), ordered_.end(), [&](const auto* p, const auto* q) { return name(p) < name(q); });
}

std::span<const gpu::UnresolvedPair* const> UnresolvedPairs::of(uint32_t sensor) const {
  const auto first =
      std::partition_point(ordered_.begin(), ordered_.end(), [&](const auto* pair) { return pair->sensor < sensor; });
  const auto end =
      std::partition_point(first, ordered_.end(), [&](const auto* pair) { return pair->sensor == sensor; });
  return {first, end};
}

Result decideUnresolved(const Result& found, std::span<const gpu::UnresolvedPair* const> pairs, const Query& query) {
  ExactPairs exact(query);
  for (const gpu::UnresolvedPair* pair : pairs) {
    exact.consider({pair->object, pair->triB, pair->triA}, placedPair(*pair, query));
    if (query.anyHit && exact.found()) break;
  }
  Result result;
  result.tier = Tier::contact;
  result.status = Status::clear;
  if (!exact.found()) {
    if (found.detected == Detected::yes) throw Error("the contact search lost what it met", VK_ERROR_UNKNOWN);
  } else if (query.anyHit) {
    result.status = Status::hit;
    result.detected = Detected::yes;
    result.lo = 0;
    result.hi = query.distance;
  } else {
    exact.tell(result);
  }
  return result;
}

Result clearAnswer() {
  Result result;
  result.status = Status::clear;
  result.tier = Tier::contact;
  return result;
}

}  // namespace radar
