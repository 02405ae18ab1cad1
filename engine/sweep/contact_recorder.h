// The recipe of the contact tier: bounds, pairs of clusters, search. Owns its pipelines and buffers.
#pragma once

#include <functional>
#include <span>

#include "gpu/pipeline.h"
#include "gpu/submission.h"
#include "sweep/contact_plan.h"
#include "sweep/mask_recorder.h"
#include "sweep/resident_scene.h"

namespace radar {

/// What the device says of one plan: valid until the next call.
struct Search {
  gpu::State state;
  std::span<const gpu::Contender> contenders;
};

/// How a search goes about what its clusters' boxes leave. The answers have the same bits.
enum class ContactWay {
  cheaper,  ///< direct, until what is left would cost more than the mask; then by the mask
  direct,   ///< pair by pair, whatever it costs
  masked    ///< by the mask at once
};

/// Room for the lists of one plan at first, how many cluster pairs a search orders at a time, and how it goes: tests
/// make them small.
struct ContactRoom {
  uint64_t pairs = 4096;
  uint64_t pairsPerCluster = 32;  ///< where that is more: meshes over each other share columns of clusters
  uint32_t contenders = 256;
  uint32_t run = 4096;
  ContactWay way = ContactWay::cheaper;
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
                              std::vector<StageTime>& stages, const std::function<void(size_t, const Search&)>& found);

 private:
  /// Room for the lists of one plan.
  struct Room {
    size_t plan;
    uint64_t pairs;
    uint32_t contenders;
    float hi;  ///< first contact is no later, world units
  };

  gpu::Pipeline searchPipeline(const char* name, uint32_t masked) const;
  std::vector<Room> nextGroup();
  void submitGroup(std::span<const ContactPlan* const> plans, const Scene::Impl& scene);
  void stage(std::span<const ContactPlan* const> plans, std::span<const Room> rooms, const Scene::Impl& scene);
  void bind();
  void dispatch(const gpu::Commands& commands, const gpu::Pipeline& pipeline, uint32_t groups, uint32_t count) const;
  void recordPairs(const gpu::Commands& commands);
  void recordSearch(const gpu::Commands& commands, const gpu::Pipeline& pipeline);
  void recordReadback(const gpu::Commands& commands);
  /// Stages the masks of the searches that ask for one, which begin anew.
  bool stageMasks();
  /// Submits until no search is unfinished.
  void finish(std::vector<StageTime>& stages);

  const Device::Impl* device_;
  ResidentScene& resident_;
  ContactRoom room_;
  gpu::Upload upload_;
  gpu::Submission submission_;
  gpu::Bindings bindings_;
  gpu::Pipeline bounds_, pairs_, direct_, masked_;
  MaskRecorder mask_;
  gpu::Buffer targets_, placements_, refs_, boxes_, items_, clusterPairs_, states_, contenders_, readback_;
  std::vector<gpu::Target> targetList_;
  std::vector<gpu::Placement> placementList_;
  std::vector<gpu::ClusterRef> refList_;
  std::vector<gpu::PairItem> itemList_;
  std::vector<gpu::State> stateList_;
  std::vector<MaskRecorder::Sides> sides_;  ///< of each target
  uint64_t contenderTotal_ = 0;
  std::vector<Room> waiting_, group_;  ///< to be searched, and with the device
  std::vector<size_t> refused_;
};

}  // namespace radar
