// Searches two meshes at rest for their nearest triangles.
#pragma once

#include <vector>

#include "cpu/clearance.h"
#include "cpu/mesh_search.h"

namespace radar::cpu {

/// Reuses its memory between searches. For one thread at a time.
class NearestSearch {
 public:
  /// Passes all pairs of triangles of a sensor and an object that may be the nearest; adds them to `pairs`. `stop`: as
  /// of MeshSearch.
  void run(const PlacedMesh& sensor, const PlacedMesh& other, ObjectId object, NearestAtStart& nearest, uint64_t& pairs,
           const std::stop_token& stop);

 private:
  struct Open {
    double least;  ///< bound on the distance
    uint32_t a, b;
  };
  std::vector<Open> open_;
};

}  // namespace radar::cpu
