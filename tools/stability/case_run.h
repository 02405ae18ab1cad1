// Hard cases asked of the device, and every answer judged by the CPU's exact one.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "stability/judge.h"
#include "stability/method.h"
#include "workloads/hard_cases.h"

namespace radar::tools {

/// Meshes to ask about in random poses, by the name of the family that they make.
using MeshFamilies = std::map<std::string, std::vector<MeshData>>;

/// The families that a CaseRun knows: those of hard cases; `at-distance`: all of them in turn, with D at the t that the
/// CPU finds, one ulp less and one ulp more; and those of `meshes`.
std::vector<std::string> runFamilies(const MeshFamilies& meshes = {});

struct CaseRange {
  std::string family;
  uint64_t seed = 1, first = 0, cases = 0;
  Company company = Company::mixed;  ///< meshes are always mixed
};

class CaseRun {
 public:
  explicit CaseRun(const Device& device, MeshFamilies meshes = {});
  ~CaseRun();

  /// Receives the case's number, who was asked and what is wrong. The paper's min(L) guarantees nothing, so its errors
  /// are only counted.
  using OnWrong = std::function<void(uint64_t, const Approach&, const std::string&)>;

  /// A tally of each of `asked`. Query i of a family and a seed is the same in any range that has it. `onProgress`
  /// receives the number of cases just done.
  std::vector<Tally> run(const CaseRange& range, std::span<const Approach> asked, const OnWrong& onWrong,
                         const std::function<void(uint64_t)>& onProgress);
  /// Mode contact alone.
  Tally run(const CaseRange& range, const OnWrong& onWrong, const std::function<void(uint64_t)>& onProgress);

 private:
  struct Stage;
  std::unique_ptr<Stage> stage_;
};

/// One of so many scenes is asked at that resolution: from 256 on fewer, as pixels grow more.
uint32_t strideOf(uint32_t resolution);

}  // namespace radar::tools
