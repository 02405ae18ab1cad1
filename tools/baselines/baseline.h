// What people use today for the same question, each behind one narrow interface. Built with -DRADAR_BASELINES=ON;
// without, there are none.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "workloads/workload.h"

namespace radar::tools {

/// One library in one thread, with structures of its own over a workload's meshes. It is made to last: show() may be
/// called again and again.
class Baseline {
 public:
  virtual ~Baseline() = default;

  /// These are the objects from now on; they stay where they are until the next show().
  virtual void show(std::span<const Instance> objects) = 0;

  /// First contact within query.distance as this library finds it: a distance along the motion, or none. Looks at the
  /// query's sensor, direction, distance and excluded objects only.
  virtual std::optional<double> cast(const Query& query) = 0;
};

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
