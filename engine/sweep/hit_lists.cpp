#include "sweep/hit_lists.h"

#include <algorithm>

#include "query/hits.h"

namespace radar {

void HitLists::add(size_t query, const Result& answer) {
  if (answer.status != Status::clear) lists_[query].searches.push_back(answer);
}

std::optional<std::vector<Result>> HitLists::nearestOf(List list, const Query& query) {
  if (query.anyHit && !list.searches.empty()) return std::vector{list.searches.front()};  // all are alike
  if (!list.isComplete) return std::nullopt;
  if (list.searches.empty()) return std::vector<Result>();
  std::sort(list.searches.begin(), list.searches.end(),
            [](const Result& p, const Result& q) { return p.object < q.object; });
  Merged found = merged(list.searches, query.hits);
  if (!found.isCertain) return std::nullopt;
  return std::move(found.hits);
}

}  // namespace radar
