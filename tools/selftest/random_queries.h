// Seeded random queries of every family, the search on the device held against the CPU's. Query i of a family and a
// seed is the same whatever else is asked.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "radar/radar.h"
#include "workloads/workload.h"

namespace radar::tools {

/// Meshes to ask about in random poses, by the name of the family that they make.
using MeshFamilies = std::map<std::string, std::vector<MeshData>>;

/// Those of workloads/families.h; `at-distance`: all of them in turn, asked again with D at the t that the CPU found,
/// one ulp less and one ulp more; and those of `meshes`.
std::vector<std::string> randomFamilies(const MeshFamilies& meshes = {});

struct RandomTally {
  uint64_t queries = 0, hits = 0, clear = 0, overlaps = 0;
  uint64_t missed = 0, falseHits = 0, unanswered = 0, wrongStatus = 0, wrongPair = 0, brackets = 0, late = 0,
           points = 0, normals = 0;
  uint64_t wrong = 0;     ///< queries with anything wrong
  double worstError = 0;  ///< |t - t*| / max(size of the sensor, t*)
  uint64_t pairs = 0, cpuPairs = 0;
  double deviceSeconds = 0, cpuSeconds = 0;
  void add(const RandomTally& other);
};

class RandomQueries {
 public:
  explicit RandomQueries(const Device& device, MeshFamilies meshes = {});
  ~RandomQueries();

  struct Range {
    std::string family;
    uint64_t seed = 1, first = 0, queries = 0;
  };
  /// `onWrong` is told the query's number and what is wrong; `onProgress` the queries done so far.
  RandomTally run(const Range& range, const std::function<void(uint64_t, const std::string&)>& onWrong,
                  const std::function<void(uint64_t)>& onProgress);

 private:
  struct Stage;
  std::unique_ptr<Stage> stage_;
};

}  // namespace radar::tools
