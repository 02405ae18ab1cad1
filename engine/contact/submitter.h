// Runs the contact tier on the engine's queue, one batch at a time.
#pragma once

#include "contact/decode.h"
#include "contact/pass.h"
#include "gpu/submission.h"
#include "query/cancelled.h"

namespace radar {

/// The device's answers to a batch; valid until the next submit() but one.
struct SearchAnswers {
  std::span<Result> results;  ///< one per search; whoever reads them may change them
  std::vector<gpu::UnresolvedPair> unresolved;
  bool roomier = false;        ///< this batch had too little room for candidates; the next one has more
  uint64_t trianglePairs = 0;  ///< tested
};

/// How many iterations a workgroup may take in a round, so that a device ends each submission soon: systems reset one
/// that takes seconds. Begins with few; learns from submissions that left work over.
class Pace {
 public:
  /// `isHurried`: else `most`, always.
  Pace(bool isHurried, uint32_t most) : most_(most), isHurried_(isHurried), budget_(isHurried ? kFirst : most) {}
  uint32_t budget() const { return budget_; }
  /// Ever more while submissions take less than half of kWantedMs, fewer when one takes longer.
  void took(double ms);

  static constexpr double kWantedMs = 20;
  static constexpr uint32_t kFirst = kBriefBudget, kLeast = 16;

 private:
  uint32_t most_;
  bool isHurried_;
  uint32_t budget_;
};

/// How many rounds a submission records: each costs its dispatches, though nothing may be left to do; too few cost
/// another submission. As many as batches have taken lately.
class Rounds {
 public:
  /// `most`: and at first. Unless it learns, always.
  Rounds(uint32_t most, bool learns) : most_(most), count_(most), learns_(learns) {}
  uint32_t count() const { return count_; }
  /// A batch was done after so many rounds; more than count(): it was not, with these.
  void took(uint32_t rounds);

 private:
  uint32_t most_, count_;
  bool learns_;
};

class ContactSubmitter {
 public:
  ContactSubmitter(const gpu::Owner& owner, GpuScene& scene, bool timestamps, const SearchTuning& tuning);

  /// Submits the batch and returns without waiting; call collect() next.
  void submit(const SearchSource& batch, const Scene::Impl& scene);
  /// Waits, and submits more rounds until the search is complete. The flags of an invalid result tell what the device
  /// had no room or range for. Throws Cancelled instead of submitting a round after `stop` is requested.
  SearchAnswers collect(std::vector<StageTime>& stages, const std::stop_token& stop);
  /// Waits for the submission in hand. Without collect(), the rest of the batch's search is left.
  void wait();
  uint32_t submissions() const { return submissions_; }  ///< made for the last batch
  /// Of the last batch, once collected.
  const gpu::SearchCounts& counts() const;

 private:
  void recordAndSubmit();

  GpuScene& scene_;
  decltype(SearchTuning::now) now_;  ///< the machine's clock, if there is no other
  Pace pace_;
  Rounds rounds_;
  gpu::Submission submission_;
  ContactPass pass_;
  std::array<gpu::Buffer, 2> readbacks_;  ///< counts, then results: those of the last batch, and of the one before
  size_t readback_ = 0;
  GpuScene::Staged staged_;
  uint32_t submissions_ = 0;
};

}  // namespace radar
