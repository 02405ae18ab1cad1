// One recording: what it searches, and how its answers are read.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "contact/search_plan.h"
#include "embed/host_geometry.h"
#include "radar/answers.h"
#include "scene/gpu_scene.h"
#include "shaders/embed/interop.h"

namespace radar {

struct Recorded {
  bool isComplete = false;     ///< else there is nothing to read
  bool isWritten = false;      ///< a host's shader writes the queries
  uint32_t count = 0;          ///< of queries; of written ones, HostQueries::count
  std::vector<Query> queries;  ///< none if they are written
  SearchPlan searches;
  std::vector<gpu::Gathered> gathered;  ///< queries that take several searches, in their order
  std::vector<uint32_t> hitOffsets;     ///< where the lists of the queries begin in `known`, and the last one ends
  std::vector<Result> known;            ///< of queries, their lists, and searches past one object each
  std::vector<double> tolerances;       ///< of the queries' clearances
  GpuScene::Farthest farthest;          ///< Mesh::farthest of the meshes that it searches

  /// Plans the searches of valid queries that routeOf() does not leave to the CPU. Throws Error if they take more than
  /// `mostSearches` past one object each, or one query more than 2^15.
  void plan(std::span<const Query> asked, const Scene::Impl& scene, const HostGeometryPass& geometry,
            uint32_t mostSearches);
  /// The same for queries that a host's shader writes.
  void planWritten(uint32_t most);
  /// Searches past one object each.
  uint32_t searchCount() const { return static_cast<uint32_t>(known.size()) - (known.empty() ? 0 : hitOffsets.back()); }
  /// Takes the boxes of meshes whose vertices only the device knew.
  void learn(const std::map<MeshId, Box>& boxes);
  /// The answers, from all that the device wrote: results in the order of `known`, and the pairs that it left open.
  Answers answers(std::vector<Result> all, std::span<const gpu::UnresolvedPair> pairs) const;
  /// The same for written queries; `sweeps`: as the device encoded them, one per result.
  Answers answersToWritten(std::vector<Result> all, std::span<const gpu::UnresolvedPair> pairs,
                           const gpu::Sweep* sweeps) const;

 private:
  void planSearch(const Query& query, uint32_t result, ObjectId object, const Scene::Impl& scene,
                  const HostGeometryPass& geometry);
};

}  // namespace radar
