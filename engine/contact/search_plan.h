// Plans the searches of queries for the device, which encodes them (shaders/contact/encode.comp.glsl).
#pragma once

#include <span>
#include <vector>

#include "exact/translation.h"
#include "scene/scene.h"
#include "shaders/contact/interop.h"

namespace radar {

enum class Planned {
  added,
  clear,      ///< nothing is in reach
  outOfRange  ///< floats cannot hold the scene or the direction; for the rest, the device finds out
};

/// What one submission or recording searches.
struct SearchPlan {
  /// The searches of a query: one past all objects, or several past one object each, by ascending object.
  struct Group {
    size_t query;
    uint32_t first, count;
  };

  std::vector<gpu::StatedSearch> stated;
  std::vector<gpu::Sweep> sweeps;  ///< of the same searches, in double precision
  std::vector<uint32_t> excluded;
  std::vector<Group> groups;  ///< in the order of their searches

  uint32_t count() const { return static_cast<uint32_t>(stated.size()); }
  void clear();
  /// Adds a search for a valid query; its answer gets the index `result`. `object`: the only one to search, or kNone:
  /// all, if none moves. Times of a step are fractions.
  Planned add(const Query& query, uint32_t result, const Scene::Impl& scene, const ObjectTree& tree,
              ObjectId object = kNone);
  /// Makes a group of the searches from `first` on, unless there are none. Returns whether it did.
  bool group(size_t query, uint32_t first);
  /// Forgets all but the first `count` searches, which are those of whole groups.
  void truncate(uint32_t count);
};

/// The group of a search.
const SearchPlan::Group& groupOf(std::span<const SearchPlan::Group> groups, uint32_t search);

/// A query's search in double precision, but for what depends on a scale. `motion`: the query's; `direction`: that of
/// the motion, by scaledDirection(). `result`: the index of its answer.
gpu::Sweep sweepOf(const Query& query, const Translation& motion, const Vector& direction, uint32_t result);

}  // namespace radar
