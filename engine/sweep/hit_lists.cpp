#include "sweep/hit_lists.h"

#include <algorithm>
#include <tuple>

namespace radar {

void HitLists::add(size_t query, const Result& answer) {
  if (answer.status != Status::clear) lists_[query].hits.push_back(answer);
}

std::optional<std::vector<Result>> HitLists::nearestOf(List list, const Query& query) {
  std::vector<Result>& hits = list.hits;
  if (query.anyHit && !hits.empty()) return std::vector{hits.front()};  // all are alike
  if (!list.isComplete) return std::nullopt;
  const uint32_t most = query.hits;
  std::sort(hits.begin(), hits.end(),
            [](const Result& p, const Result& q) { return std::tie(p.t, p.object) < std::tie(q.t, q.object); });
  // Brackets that meet leave the order open, unless both times are exact: at the start or at D.
  for (size_t i = 0; i + 1 < hits.size() && i < most; ++i) {
    const Result &p = hits[i], &q = hits[i + 1];
    if (p.hi >= q.lo && !(p.lo == p.hi && q.lo == q.hi)) return std::nullopt;
  }
  if (hits.size() > most) hits.resize(most);
  return hits;
}

}  // namespace radar
