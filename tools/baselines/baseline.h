// Other libraries that answer the same question, behind one interface. -DRADAR_BASELINES=ON builds them; without it
// there are none.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "workloads/workload.h"

namespace radar::tools {

/// One library in one thread, with its own structures over a workload's meshes.
class Baseline {
 public:
  virtual ~Baseline() = default;

  /// Replaces the objects.
  virtual void show(std::span<const Instance> objects) = 0;

  /// First contact within query.distance as this library finds it: a distance along the motion, or none. Uses
  /// only the query's sensor, direction, distance and excluded objects.
  virtual std::optional<double> cast(const Query& query) = 0;
};

/// What FCL says of bodies among a workload's first scene, whose objects stand.
class RigidBodies {
 public:
  virtual ~RigidBodies() = default;
  /// The least distance of a body from the scene.
  virtual double distance(const Instance& body) = 0;
  /// First contact by discrete checks (steppedContact) of bodies that are at `at(s)`, for s from 0 to 1.
  virtual std::optional<double> stepped(uint32_t steps, const std::function<std::vector<Instance>(double)>& at) = 0;
  /// First contact by FCL's continuous mode, on a body's way to the pose `end`: its origin goes straight while it turns
  /// evenly, by less than half a turn. In `steps`, since its conservative advancement finds nothing between meshes (FCL
  /// 0.7.0), even where two boxes move straight onto each other.
  virtual std::optional<double> continuous(const Instance& body, const Transform& end, uint32_t steps) = 0;
};
/// None if libraries are not built. The workload outlives it.
std::unique_ptr<RigidBodies> makeRigidBodies(const Workload& workload);

/// What trees take: seconds, and the bytes that are held then, with those of what they are over.
struct TreeCost {
  double build = 0, refit = 0, bytes = 0;
};
/// Of Embree's tree over a mesh, of medium quality, on all cores, its vertices moved for the refit; or over instances
/// of it at `places`, if there are any, to which they are moved again. None if libraries are not built.
std::optional<TreeCost> embreeTree(const MeshData& mesh, std::span<const float> moved,
                                   std::span<const Transform> places);

/// A row of the chart: a library, used in one way.
struct BaselineRow {
  std::string family;
  std::string product;          ///< with its version
  std::string limits;           ///< what it cannot do, for the reader
  std::vector<uint32_t> sizes;  ///< resolutions or steps; {0}: the row has one member
  std::vector<std::string> sections{"front", "table1", "growth"};  ///< where it is fast enough to be measured
  bool threads = true;                                             ///< it can be used in several threads at once
  std::unique_ptr<Baseline> (*make)(const Workload& workload, uint32_t size);
};

std::vector<BaselineRow> peerRows();

}  // namespace radar::tools
