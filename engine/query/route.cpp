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

}  // namespace radar
