// Whether a query can be answered, and by whom.
#pragma once

#include "scene/scene.h"

namespace radar {

enum class Route : uint8_t {
  cpu,        ///< the CPU's search only: it combines what the device's does not
  oneSearch,  ///< one search of the device past all objects
  searchEach  ///< one search of the device past each object in reach, since several hits are asked for or objects move
};

/// Null, or what of a query only the CPU's search combines. `canRevise`: what the device finds is looked at before it
/// is an answer, as a Sweeper does; a Recorder's device leaves answers behind.
const char* onlyForCpu(const Query& query, const Scene::Impl& scene, bool canRevise);

Route routeOf(const Query& query, const Scene::Impl& scene, bool canRevise);

/// What answering a query takes, so that one look at it suffices.
struct SearchNeeds {
  Route route = Route::cpu;
  bool isPlain = false;  ///< no options but a mask and `anyHit`: what one search finds is the answer
  bool ignoresLeaving = false, hasClearance = false, excludes = false, lists = false;
  SearchNeeds() = default;
  /// Of a valid query.
  SearchNeeds(const Query& query, const Scene::Impl& scene);
};

/// Throws Error, naming the first query that breaks its contract or, if they are recorded, that only the CPU answers.
/// `threads`: at most; 0: one for each core. `needs`: none, or to be written, one for each query.
void requireValid(std::span<const Query> queries, const Scene& scene, Mode mode = Mode::contact,
                  bool areRecorded = false, unsigned threads = 1, std::span<SearchNeeds> needs = {});

}  // namespace radar
