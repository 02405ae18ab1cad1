#include "query/route.h"

#include <atomic>

#include "math/vector.h"
#include "query/hits.h"
#include "scene/parallel.h"

namespace radar {

namespace {

// Queries that take as long to validate as a thread to wake.
constexpr size_t kWorthThread = 4096;

// Whether a query is plain (SearchNeeds) and certainly valid, as most are.
bool isPlain(const Query& query, const Scene& scene) {
  const Scene::Impl& impl = scene.impl();
  const bool hasOptions = query.turn || impl.moving > 0 || !query.exclude.empty() || query.ignoreLeaving ||
                          query.clearance != 0 || query.slack || query.tolerance || hasLists(query) ||
                          query.hits != 1 || query.resolution > kMaxResolution;
  if (hasOptions || !scene.hasMesh(query.mesh) || !impl.meshes[query.mesh].parts.empty()) return false;
  const double size = norm1(query.direction), far = 0x1p1000;
  const bool isUsual = query.motion ? size == 0 && query.distance == 0 && norm1(*query.motion) <= far
                                    : size >= 1 / far && size <= far && query.distance >= 0 && query.distance <= far;
  return isUsual && isSurelyValid(query.worldFromMesh);
}

}  // namespace

const char* onlyForCpu(const Query& query, const Scene::Impl& scene, bool canRevise) {
  if (!scene.meshes[query.mesh].parts.empty()) return "a cutter";
  if (query.turn) return "a turn";
  if (query.closest || query.exit) return "closest or exit";
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

SearchNeeds::SearchNeeds(const Query& query, const Scene::Impl& scene)
    : route(routeOf(query, scene, true)),
      isPlain(route == Route::oneSearch && query.clearance == 0 && !query.ignoreLeaving && query.exclude.empty() &&
              !hasLists(query)),
      ignoresLeaving(query.ignoreLeaving),
      hasClearance(query.clearance > 0),
      excludes(!query.exclude.empty()),
      lists(hasLists(query)) {}

void requireValid(std::span<const Query> queries, const Scene& scene, Mode mode, bool areRecorded, unsigned threads,
                  std::span<SearchNeeds> needs) {
  const auto problemOf = [&](const Query& query) {
    std::string wrong = validate(query, scene, mode);
    const char* what = wrong.empty() && areRecorded ? onlyForCpu(query, scene.impl(), false) : nullptr;
    if (what != nullptr) wrong = std::string("only the CPU answers ") + what + ": ask a Sweeper";
    return wrong;
  };
  std::atomic<size_t> first = queries.size();  // of those that are wrong
  SearchNeeds plain;
  plain.route = Route::oneSearch;
  plain.isPlain = true;
  const auto check = [&](size_t from, size_t to) {
    for (size_t i = from; i < to; ++i) {
      const bool isKnown = isPlain(queries[i], scene);
      if (isKnown || problemOf(queries[i]).empty()) {
        if (!needs.empty()) needs[i] = isKnown ? plain : SearchNeeds(queries[i], scene.impl());
        continue;
      }
      for (size_t least = first; i < least && !first.compare_exchange_weak(least, i);) {
      }
      return;
    }
  };
  parallelFor(queries.size(), kWorthThread, threads, [&](unsigned, size_t from, size_t to) { check(from, to); });
  if (first == queries.size()) return;
  throw Error("query " + std::to_string(first) + ": " + problemOf(queries[first]));
}

}  // namespace radar
