// The bounded tier: brackets from outer scopes, refined until they settle what was asked.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "sweep/bounded_recorder.h"

namespace radar {

/// Where a query starts that leaves the resolution open, and where refining ends.
inline constexpr uint32_t kCoarsest = 64, kFinest = 256;

class BoundedTier {
 public:
  /// `pictureBytes`: upper bound for the scopes of one submission, unless one query alone needs more.
  BoundedTier(const Device::Impl& device, ResidentScene& resident, uint64_t pictureBytes, bool timestamps);

  /// What a run adds to, by query.
  struct Out {
    std::span<Result> results;
    std::map<size_t, std::string>& reasons;
    SweepStats& stats;
    std::function<void(size_t, const Error&)> giveUp;  ///< of a query whose submission failed
  };

  /// Answers the queries `which`: clear (tier select or bounded), or with the bracket that is known. In mode bounded a
  /// query that leaves the resolution open is refined, from kCoarsest by doubling to kFinest, while it is not settled;
  /// one of a dearer mode, or with a resolution, is looked at once. Returns those that are not settled, in order.
  std::vector<size_t> run(std::span<const Query> queries, std::span<const size_t> which, const Scene::Impl& scene,
                          const Hierarchy& hierarchy, const Out& out);

  /// One look, with its pictures.
  OuterScopes look(const Query& query, const Scene::Impl& scene, const Hierarchy& hierarchy, SweepStats& stats);

 private:
  struct Pending {
    size_t query;
    BoundedPlan plan;
  };
  /// What one submission has to hold.
  struct Load {
    uint64_t views = 0, pixels = 0, draws = 0, items = 0, bands = 0;
    void add(const BoundedPlan& plan);
  };

  bool fits(const Load& load, bool alone) const;
  void submit(std::span<const Query> queries, std::vector<Pending>& slice, const Scene::Impl& scene, const Out& out);

  const Device::Impl* device_;
  uint64_t pictureBytes_, bufferBytes_;
  bool timestamps_;
  BoundedRecorder recorder_;
};

}  // namespace radar
