// Other libraries that answer the same question, behind one interface. -DRADAR_BASELINES=ON builds them; without it
// there are none.
#pragma once

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

/// Least distances of bodies to a workload's first scene, as FCL computes them.
class Distances {
 public:
  virtual ~Distances() = default;
  virtual double of(const Instance& body) = 0;
};
/// None if libraries are not built. The workload outlives it.
std::unique_ptr<Distances> makeDistances(const Workload& workload);

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
