// Answers one query on one thread: traverses the tree over the objects, nearest first.
#pragma once

#include <vector>

#include "cpu/mesh_search.h"

namespace radar::cpu {

/// Reuses its memory between queries. For one thread at a time.
class QuerySearch {
 public:
  /// Answers a valid query, except for the tier. `tree` is the scene's; neither changes meanwhile.
  Result answer(const Query& query, const Scene::Impl& scene, const ObjectTree& tree);
  const SearchStats& stats() const { return stats_; }

 private:
  struct Task;
  struct Open {
    double near;
    uint32_t link;
  };

  void searchTree(Task& task, const ObjectTree& tree);
  void searchObject(Task& task, ObjectId id);

  std::vector<Open> open_;
  MeshSearch meshes_;
  SearchStats stats_;
};

}  // namespace radar::cpu
