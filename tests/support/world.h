// What tests make of the engine's words: meshes in a scene, poses, and cases.
#pragma once

#include "workloads/vectors.h"
#include "workloads/workload.h"

namespace radar::test {

inline MeshId add(Scene& scene, const tools::MeshData& mesh) {
  return scene.addMesh(mesh.positions, mesh.indices);
}

inline Transform at(double x, double y, double z) {
  return tools::placedAt({x, y, z});
}

inline tools::Vec3 placeOf(const Transform& pose) {
  return {pose.m[3], pose.m[7], pose.m[11]};
}

/// A scene, and queries through it.
struct Case {
  Scene scene;
  std::vector<Query> queries;
};

/// A workload's first scene, and its queries, to be drawn with that resolution.
inline Case caseOf(const tools::Workload& workload, uint32_t resolution = 0) {
  Case out;
  replaceBy(workload, 0, out.scene);
  out.queries = tools::queriesOf(workload.queries, resolution);
  return out;
}

}  // namespace radar::test
