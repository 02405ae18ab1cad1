#include "query/route.h"

namespace radar {

Route routeOf(const Query& query, const Scene::Impl& scene, bool canRevise) {
  const bool step = isStep(query, scene);
  if (query.clearance > 0 && (query.ignoreLeaving || query.hits > 1 || step)) return Route::cpu;
  // What crosses at the start is dropped from what was found, and times of a step become distances.
  if (!canRevise && (query.skipOverlapping || (step && !query.motion))) return Route::cpu;
  return query.hits > 1 || scene.moving > 0 ? Route::searchEach : Route::oneSearch;
}

}  // namespace radar
