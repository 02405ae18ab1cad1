#include "query/route.h"

namespace radar {

const char* onlyForCpu(const Query& query, const Scene::Impl& scene, bool canRevise) {
  const bool step = isStep(query, scene);
  if (query.clearance > 0 && (query.ignoreLeaving || query.hits > 1 || step)) {
    return "a clearance with ignoreLeaving, hits or a step";
  }
  if (canRevise) return nullptr;
  if (query.skipOverlapping) return "skipOverlapping";
  // Times of such a step would have to become distances.
  return step && !query.motion ? "a direction while objects move" : nullptr;
}

Route routeOf(const Query& query, const Scene::Impl& scene, bool canRevise) {
  if (onlyForCpu(query, scene, canRevise) != nullptr) return Route::cpu;
  return query.hits > 1 || scene.moving > 0 ? Route::searchEach : Route::oneSearch;
}

void requireValid(std::span<const Query> queries, const Scene& scene, Mode mode, bool areRecorded) {
  for (size_t i = 0; i < queries.size(); ++i) {
    std::string wrong = validate(queries[i], scene, mode);
    const char* what = wrong.empty() && areRecorded ? onlyForCpu(queries[i], scene.impl(), false) : nullptr;
    if (what != nullptr) wrong = std::string("only the CPU combines ") + what + ": ask a Sweeper";
    if (!wrong.empty()) throw Error("query " + std::to_string(i) + ": " + wrong);
  }
}

}  // namespace radar
