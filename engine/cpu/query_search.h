// The search for the answer to one query, on one thread: nearest first down the tree over the objects.
#pragma once

#include <vector>

#include "cpu/mesh_search.h"

namespace radar::cpu {

/// Keeps its memory from one query to the next. One thread at a time.
class QuerySearch {
 public:
  /// The answer to a query that holds its contract, but for the tier. `tree` is the scene's; neither changes meanwhile.
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
