// The contact tier on a queue of the engine's: what outgrows its room, or takes longer than a dispatch may, goes again.
#pragma once

#include <functional>
#include <span>

#include "gpu/submission.h"
#include "sweep/contact_pass.h"

namespace radar {

/// What the device says of one plan: valid until the next call.
struct Found {
  gpu::State state;
  Result result;                                    ///< undecided where something is open
  std::span<const gpu::OpenContender* const> open;  ///< what may be first, for `exact` to decide
};

class ContactRecorder {
 public:
  ContactRecorder(const Device::Impl& device, ResidentScene& resident, bool timestamps, const ContactRoom& room = {});

  /// Begins the search for the first contact of every plan: one upload, one command buffer, one readback; returns while
  /// the device works on it, and collect() comes next, with the same arguments.
  void submit(std::span<const ContactPlan* const> plans, const Scene::Impl& scene);
  /// Waits for what was submitted; submits more only where a list was longer than its room or a search longer than a
  /// dispatch may be. `found` is called once for every plan, in no order.
  /// Returns the plans whose lists are longer than a buffer of the device may be: for those `found` is not called.
  std::vector<size_t> collect(std::span<const ContactPlan* const> plans, const Scene::Impl& scene,
                              std::vector<StageTime>& stages, const std::function<void(size_t, const Found&)>& found);

 private:
  /// Room for the lists of one plan.
  struct Room {
    size_t plan;
    uint64_t pairs;
    uint32_t contenders;
    float hi;  ///< first contact is no later, world units
  };

  std::vector<Room> nextGroup();
  void submitGroup(std::span<const ContactPlan* const> plans, const Scene::Impl& scene);
  void recordReadback(const gpu::Commands& commands);
  /// Submits until no search is unfinished, and all that is open is listed.
  void finish(std::vector<StageTime>& stages);
  void submitAgain(std::vector<StageTime>& stages, const ContactPass::Again& again);
  const gpu::State* states() const;
  const Result* results() const;

  const Device::Impl* device_;
  ResidentScene& resident_;
  ContactRoom room_;
  gpu::Submission submission_;
  ContactPass pass_;
  gpu::Buffer readback_;               ///< states, then results
  std::vector<Room> waiting_, group_;  ///< to be searched, and with the device
  std::vector<size_t> refused_;
};

}  // namespace radar
