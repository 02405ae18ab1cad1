// Hard cases asked of the device, and every answer judged by the CPU's exact one.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "measure/judge.h"
#include "workloads/hard_cases.h"

namespace radar::tools {

/// Mode sampled with so many pixels; with none, mode contact.
struct Approach {
  uint32_t resolution = 0;
  bool paper = false;  ///< the paper's literal min(L), which mode sampled reports beside its own answer

  Mode mode() const { return resolution == 0 ? Mode::contact : Mode::sampled; }
  /// "paper", "sampled" or "contact".
  const char* tier() const { return resolution == 0 ? "contact" : paper ? "paper" : "sampled"; }
};

/// Whether mode sampled offers what the family's queries ask for.
bool offersSampled(const HardFamily& family);

/// Meshes to ask about in random poses, by the name of the family that they make.
using MeshFamilies = std::map<std::string, std::vector<MeshData>>;

/// The families that a CaseRun knows: those of hard cases; `at-distance`: all of them in turn, with D at the t that the
/// CPU finds, one ulp less and one ulp more; and those of `meshes`.
std::vector<std::string> runFamilies(const MeshFamilies& meshes = {});

struct CaseRange {
  std::string family;
  uint64_t seed = 1, first = 0, cases = 0;
  Company company = Company::mixed;  ///< meshes are always mixed
  bool ignoreLeaving = false;        ///< every query ignores what it leaves, not only those of bodies at rest
  bool allHits = false;              ///< every query lists the contacts with all objects
  bool clearances = false;           ///< every query has a clearance, from far less than its sensor's size to more
  bool steps = false;                ///< objects move, too
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
  Tally run(
      const CaseRange& range, const OnWrong& onWrong = [](uint64_t, const Approach&, const std::string&) {},
      const std::function<void(uint64_t)>& onProgress = [](uint64_t) {});

 private:
  struct Stage;
  std::unique_ptr<Stage> stage_;
};

}  // namespace radar::tools
