// A sweep in two halves: whoever has two of these encodes one batch while the device works on the other.
#pragma once

#include <chrono>
#include <map>
#include <optional>

#include "scene/hierarchy.h"
#include "sweep/bounded_tier.h"
#include "sweep/contact_recorder.h"
#include "sweep/sampled_recorder.h"

namespace radar {

/// A scene as one device sees it: its copy there, and the tree over its objects.
struct SceneCopy {
  explicit SceneCopy(const Device::Impl& device) : resident(device) {}
  ResidentScene resident;
  Hierarchy hierarchy;
};

struct Sweeper::Impl {
  /// `copy` may be shared with others of the same device and scene, used by the same thread; a scene that changed is
  /// then brought there by sync(), while nothing is with the device.
  Impl(const Device& device, const Scene& scene, const SweeperOptions& options, std::shared_ptr<SceneCopy> copy,
       const ContactRoom& room = {});

  void sync();
  /// Encodes `queries`, which keep their contracts, and submits them; on return the last submission is still with the
  /// device. `queries` and `results`, one for each, stay where they are until finish(), which comes next.
  void begin(std::span<const Query> queries, std::span<Result> results);
  void finish();

  // Of the last begin() and finish().
  SweepStats stats;
  std::map<size_t, std::string> reasons;
  std::optional<Error> failure;  ///< the first Vulkan call that failed
  std::chrono::steady_clock::time_point deviceDone;

  /// One query of a slice on its way to the device.
  struct Pending {
    size_t query;
    ViewPlan plan;
  };
  /// What one submission has to hold.
  struct Load {
    uint64_t views = 0, draws = 0, items = 0;
    uint32_t resolution = 0;
  };
  enum class Flight { none, sampled, contact };

  bool fits(const Load& load) const;
  static void add(Load& load, const ViewPlan& plan);
  std::string tooLarge(const ViewPlan& plan) const;
  void flush(std::vector<Pending>& slice);
  void submit(std::span<Pending> part);
  void runSampled(std::span<const size_t> which);
  std::vector<size_t> runBounded(std::span<const size_t> which);
  void runContact(std::span<const size_t> which);
  void search(std::vector<size_t>& which, std::vector<ContactPlan>& plans);
  /// Waits for what is with the device, if anything, and decodes it.
  void land();
  void landSampled();
  void landContact();
  void giveUp(size_t query, const Error& error);
  void addCpuTime(const char* name, double ms);
  void refuseWrong(std::span<const Query> queries) const;

  const Device::Impl& device;
  const Scene& scene;
  SweeperOptions options;
  std::shared_ptr<SceneCopy> copy;
  SampledRecorder recorder;
  BoundedTier& bounded();
  std::optional<BoundedTier> boundedTier;  ///< made when first needed: pipelines take a while
  ContactRecorder contactRecorder;
  uint64_t bufferBytes;
  uint64_t maxItems;  ///< items name triangles in 32 bits

  std::span<const Query> asked;
  std::span<Result> answers;
  Flight flight = Flight::none;
  std::vector<size_t> flying;  ///< the queries with the device, in the order of `batch.views` or `contactPlans`
  Batch batch;
  std::vector<ContactPlan> contactPlans;
  std::vector<const ContactPlan*> contactPointers;
};

}  // namespace radar
