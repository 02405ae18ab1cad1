// A small scene with everything in it, and queries of every kind: what the fault tests ask again and again.
#pragma once

#include <vector>

#include "radar/radar.h"
#include "radar/recorder.h"
#include "support/answer.h"
#include "workloads/workload.h"

namespace radar::test {

/// All kinds of edits, which make a scene of an empty one.
class SceneEdits {
 public:
  SceneEdits();
  /// Computes nothing itself.
  void make(Scene& scene) const;

 private:
  tools::Workload workload_;
  std::vector<float> moved_;
  Transform pose_;
};
/// Queries of mode contact: steps, lists, clearances, decisions, what leaves or overlaps, exclusions and masks.
std::vector<Query> contactQueries(uint32_t count = 24);
/// Those of them that a Recorder takes, with a scene at rest.
std::vector<Query> recordableQueries();
/// Queries of mode sampled, which need a scene at rest.
std::vector<Query> sampledQueries(uint32_t count = 4);

/// A batch of each mode.
struct BothModes {
  std::vector<Query> contact = contactQueries(), sampled = sampledQueries();

  /// The answers that `ask` gets to the first batch, then those to the second.
  template <class Ask>
  Answers answersBy(const Ask& ask) const {
    Answers all = ask(contact, Mode::contact), drawn = ask(sampled, Mode::sampled);
    for (const auto& [i, reason] : drawn.reasons) all.reasons[contact.size() + i] = reason;
    all.results.insert(all.results.end(), drawn.results.begin(), drawn.results.end());
    all.lists.resize(all.results.size());
    return all;
  }
  Answers answersBy(Sweeper& sweeper) const {
    return answersBy([&](const std::vector<Query>& queries, Mode mode) { return sweeper.run(queries, mode); });
  }
};

/// Whether all bits are equal.
bool sameBits(const Answers& p, const Answers& q);
/// Whether all bits but the tier are equal, which the CPU alone does not tell.
bool sameContacts(const Answers& p, const Answers& q);

/// Room for recordableQueries().
inline constexpr Capacity kScenarioRoom{
    .queries = 48, .candidates = 1u << 14, .rounds = 32, .unresolvedPairs = 1u << 12, .searches = 1u << 10};

}  // namespace radar::test
