// Plans the searches of queries for the device, which encodes them (shaders/contact/encode.comp.glsl).
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "exact/translation.h"
#include "query/route.h"
#include "scene/scene.h"
#include "shaders/contact/interop.h"

namespace radar {

enum class Planned {
  added,
  clear,      ///< nothing is in reach
  outOfRange  ///< floats cannot hold the scene or the direction; for the rest, the device finds out
};

/// The searches of a query in a submission or recording: one past all objects, or several past one object each, by
/// ascending object.
struct SearchGroup {
  size_t query;
  uint32_t first, count;
};

/// The group of a search. `groups`: in the order of their searches.
const SearchGroup& groupOf(std::span<const SearchGroup> groups, uint32_t search);

/// Searches to be staged (ContactPass): so many, and who writes them and the list of excluded objects.
struct SearchSource {
  uint32_t count = 0;
  std::span<const uint32_t> excluded;
  bool ignoresLeaving = false, hasClearances = false;  ///< some search
  /// Fills `count` of each, in memory that is slow to read.
  std::function<void(gpu::StatedSearch* stated, gpu::Sweep* sweeps)> write;
};

/// What a recording searches.
struct SearchPlan {
  std::vector<gpu::StatedSearch> stated;
  std::vector<gpu::Sweep> sweeps;  ///< of the same searches, in double precision
  std::vector<uint32_t> excluded;
  std::vector<SearchGroup> groups;  ///< in the order of their searches

  uint32_t count() const { return static_cast<uint32_t>(stated.size()); }
  void clear();
  /// Adds a search for a valid query; its answer gets the index `result`. `object`: the only one to search, or kNone:
  /// all, if none moves. Times of a step are fractions.
  Planned add(const Query& query, uint32_t result, const Scene::Impl& scene, const ObjectTree& tree,
              ObjectId object = kNone);
  /// Makes a group of the searches from `first` on, unless there are none. Returns whether it did.
  bool group(size_t query, uint32_t first);

  SearchSource source() const;
};

/// What a submission searches: stated only when that is staged, so that each search is written once, by all threads.
/// Answers get the indices of their searches; those of searches that floats cannot hold say so.
class SearchList {
 public:
  uint32_t count() const { return static_cast<uint32_t>(searches_.size()); }
  /// In the order of their searches.
  std::span<const SearchGroup> groups() const { return groups_; }
  void clear();
  void reserve(size_t searches);
  /// Adds a search for each of `objects`, of which there are some, as SearchPlan::add().
  void add(std::span<const Query> queries, size_t query, const SearchNeeds& needs, std::span<const ObjectId> objects);
  /// What the searches are of. Its tree over objects is in range and not empty.
  struct Of {
    std::span<const Query> queries;
    const Scene::Impl* scene = nullptr;
    unsigned threads = 1;
  };
  /// Once at a time; all outlive it.
  SearchSource source(const Of& of);

 private:
  struct Listed {
    size_t query;
    ObjectId object;  ///< the only one to search, or kNone
    uint32_t firstExcluded, endExcluded;
  };
  void write(gpu::StatedSearch* stated, gpu::Sweep* sweeps) const;

  Of of_;
  std::vector<Listed> searches_;
  std::vector<SearchGroup> groups_;
  std::vector<uint32_t> excluded_;
  bool ignoresLeaving_ = false, hasClearances_ = false;
};

/// A sweep's search in double precision, but for what depends on a scale. `motion`: the query's.
gpu::Sweep sweepOf(const Query& query, const Translation& motion, const Scene::Impl& scene);

}  // namespace radar
