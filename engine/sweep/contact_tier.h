// Mode contact: sends each search to the device or to the CPU's cores, and divides batches into submissions. Both give
// the same bits.
#pragma once

#include "contact/submitter.h"
#include "cpu/search.h"
#include "sweep/hit_lists.h"
#include "sweep/query_batch.h"

namespace radar {

class ContactTier {
 public:
  /// `needsProof`: that of the device (known_answers.h), unless isOnCpu().
  ContactTier(const Device::Impl& device, const Scene& scene, const SweeperOptions& options, GpuScene& resident,
              const SearchRoom& room, bool needsProof, QueryBatch& batch);

  /// Whether all batches are answered on the CPU, so that the device needs no scene.
  bool isOnCpu() const;
  /// Begins a batch. Forgets what an exception may have left of the last one.
  void begin();
  /// Plans and submits these queries; on return the last submission may still be running.
  void run(std::span<const size_t> which);
  /// Waits, and answers the queries that the device had no room or range for.
  void finish();

 private:
  /// Adds the searches of a query; returns false if the device cannot answer it. `tree`: the scene's, up to date.
  bool plan(size_t query, const ObjectTree& tree);
  Planned planOne(size_t query, ObjectId object, const ObjectTree& tree);
  void submit();
  void collect();
  void decode(const SearchAnswers& found, std::span<const size_t> queries);
  /// Keeps what a search found, unless only the CPU can tell what it means; returns whether it did.
  bool keep(size_t query, const Result& found);
  void finishLists();
  /// Leaves queries, some perhaps several times, to the CPU: those of several searches when all have ended.
  void leaveToCpu(std::vector<size_t> queries);
  void answerOnCpu(std::span<const size_t> which);  ///< ascending, each once

  const Device::Impl& device_;
  const Scene& scene_;
  const SweeperOptions options_;
  GpuScene& resident_;
  const SearchRoom room_;
  const size_t mostSensors_;  ///< per submission
  QueryBatch& batch_;
  std::optional<ContactSubmitter> submitter_;  ///< made when first needed, since all batches may be small
  cpu::Search cpu_;
  SensorBatch sensors_;
  std::vector<size_t> planned_;  ///< the queries in `sensors_`: some once for each object in reach
  cpu::QuerySearch reach_;
  HitLists lists_;
  Clock::time_point encoding_;  ///< since when the next submission is being planned
  PendingQueries pending_;
  std::vector<size_t> cramped_;  ///< queries to repeat, now that the device has room for them
};

}  // namespace radar
