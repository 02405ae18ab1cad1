// Mode contact: sends each search to the device or to the CPU's cores, and divides batches into submissions. Both give
// the same bits.
#pragma once

#include "contact/submitter.h"
#include "cpu/search.h"
#include "sweep/flight.h"

namespace radar {

class ContactRunner {
 public:
  /// `needsProof`: that of the device (sweep/proof.h), unless isOnCpu().
  ContactRunner(const gpu::Owner& owner, const Scene& scene, const SweeperOptions& options, GpuScene& resident,
                const SearchTuning& tuning, bool needsProof);

  /// Whether all batches are answered on the CPU, so that the device needs no scene.
  bool isOnCpu() const;
  /// Room for what is known of a batch, which lasts until it is answered.
  std::span<SearchNeeds> needsOf(size_t queries);
  /// Plans and submits all queries; on return the last submission may still be running. As finish(), throws Cancelled
  /// soon after the batch's stop is requested; then call abandon().
  void begin(Flight& flight);
  /// Waits, and answers the queries that the device had no room or range for.
  void finish(Flight& flight);
  /// Waits for what is running of a batch that is given up.
  void abandon(Flight& flight) noexcept;

 private:
  void plan(Flight& flight, std::span<const size_t> which);
  /// Lists the searches of a query; returns false, and lists none, if the CPU has to answer it.
  bool planQuery(Flight& flight, size_t query, const ObjectTree& tree);
  void submit(Flight& flight);
  void collect(Flight& flight);
  /// Waits for the last submission, whose searches are `groups`, and counts what it took; nothing if that fails.
  std::optional<SearchAnswers> wait(Flight& flight, std::span<const SearchGroup> groups);
  void decode(Flight& flight, const SearchAnswers& found, std::span<const SearchGroup> groups);
  /// As answerFrom(). Called on several threads, of different groups.
  bool answerGroup(Flight& flight, const SearchGroup& group, std::span<const Result> searches);
  void answerLeft(Flight& flight);
  /// Calls `step`; leaves the queries to the CPU if memory, or a limit of the device, does not suffice for it, or the
  /// device is lost, and without an answer if another Vulkan call fails. Returns whether nothing did.
  template <class Step>
  bool attempt(Flight& flight, std::span<const SearchGroup> groups, const Step& step);

  const gpu::Owner owner_;
  const Device::Impl& device_;
  const Scene& scene_;
  const SweeperOptions options_;
  GpuScene& resident_;
  const SearchTuning tuning_;
  const size_t mostSearches_;                  ///< per submission
  std::optional<ContactSubmitter> submitter_;  ///< made when first needed, since all batches may be small
  // Of one batch at a time; their memory is used again.
  std::vector<size_t> all_;
  std::vector<SearchNeeds> needs_;
  std::vector<char> open_;                     ///< Flight::open
  std::vector<SearchGroup> submitted_, last_;  ///< searches with the device, and those to decode
  SearchList planned_;                         ///< for the next submission
  cpu::Search cpu_;
  std::string lost_;  ///< as SweepStats::lost
};

}  // namespace radar
