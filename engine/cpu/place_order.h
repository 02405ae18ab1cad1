// The order in which a large batch is answered: queries that begin near each other meet the same nodes, objects and
// triangles, which are then still in a cache.
#pragma once

#include <span>
#include <vector>

#include "scene/scene.h"

namespace radar::cpu {

/// Reuses its memory. For one thread at a time.
class PlaceOrder {
 public:
  /// The numbers of the queries by where their sensors begin, along a Morton curve over the scene's box; empty if an
  /// order would gain nothing. Valid until the next call. Uses up to `threads` threads.
  std::span<const uint32_t> of(std::span<const Query> queries, const Scene::Impl& scene, const ObjectTree& tree,
                               unsigned threads);

 private:
  std::vector<uint32_t> cells_;  // by query
  std::vector<uint32_t> first_;  // by cell: where its next query goes
  std::vector<uint32_t> order_;
};

}  // namespace radar::cpu
