// The recipe of the contact tier: bounds, pairs of clusters, search, answers. Owns its pipelines and buffers; whose
// command buffer it records into is the caller's affair.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "radar/recorder.h"
#include "sweep/contact_plan.h"
#include "sweep/mask_recorder.h"
#include "sweep/resident_scene.h"
#include "sweep/tell_recorder.h"

namespace radar {

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
  uint32_t openContenders = 4096;  ///< of all plans: pairs that the device cannot decide
  uint32_t run = 4096;
  ContactWay way = ContactWay::cheaper;
};

/// Pairs that the two lists of a plan can make at most, and room for them at first.
uint64_t allPairs(const ContactPlan& plan);
uint64_t firstPairs(const ContactPlan& plan, const ContactRoom& room);

class ContactPass {
 public:
  ContactPass(const Device::Impl& device, ResidentScene& resident, const ContactRoom& room);

  /// One plan, and room for its lists.
  struct Search {
    const ContactPlan* plan;
    uint64_t pairs;
    uint32_t contenders;
    float hi;         ///< first contact is no later, world units
    uint32_t result;  ///< where its answer goes
  };
  /// Opens a stage of the commands, by its name.
  using OpenStage = std::function<void(const char*)>;

  /// Makes room for all that fits in `capacity`, so that staging that much makes none.
  void reserve(const Capacity& capacity);
  /// Fills the lists, in host memory that the device is done with. `known` are answers that need no search, with those
  /// that come from one left out.
  void stage(std::span<const Search> searches, std::span<const Result> known, const Scene::Impl& scene);
  /// What was staged comes to the device, ready for every shader.
  void recordUpload(const gpu::Commands& commands, const OpenStage& stage);
  /// Behind the upload, up to the answers; a barrier from compute shaders to what reads them comes next. A search goes
  /// on over so many dispatches at most; one that has ended costs a dispatch next to nothing.
  void record(const gpu::Commands& commands, const OpenStage& stage, uint32_t dispatches);

  /// Where searches that have ended so far left off. Stages the masks of those that ask for one, which begin anew;
  /// returns whether there are any.
  bool stageMasks(const gpu::State* states);
  /// What of the searches goes on.
  struct Again {
    bool masks, direct, masked;
  };
  void recordAgain(const gpu::Commands& commands, const OpenStage& stage, const Again& again, uint32_t dispatches);

  uint32_t searches() const { return static_cast<uint32_t>(targetList_.size()); }
  const gpu::Buffer& states() const { return states_; }          ///< State, one for each search
  const gpu::Buffer& placements() const { return placements_; }  ///< Placement, of all searches
  uint32_t placementCount() const { return static_cast<uint32_t>(placementList_.size()); }
  TellRecorder& tell() { return tell_; }

 private:
  gpu::Pipeline searchPipeline(const char* name, uint32_t masked) const;
  void bind();
  void dispatch(const gpu::Commands& commands, const gpu::Pipeline& pipeline, uint32_t groups, uint32_t count) const;
  void recordPairs(const gpu::Commands& commands, const OpenStage& stage);
  void recordSearch(const gpu::Commands& commands, const gpu::Pipeline& pipeline, uint32_t dispatches);
  void recordAnswers(const gpu::Commands& commands, const OpenStage& stage);

  const Device::Impl* device_;
  ResidentScene& resident_;
  ContactRoom room_;
  gpu::Upload upload_;
  gpu::Bindings bindings_;
  gpu::Pipeline bounds_, pairs_, direct_;
  struct Masked {
    MaskRecorder mask;
    gpu::Pipeline search;
  };
  std::optional<Masked> masked_;  ///< unless all goes direct
  TellRecorder tell_;
  gpu::Buffer targets_, placements_, refs_, boxes_, items_, clusterPairs_, states_, contenders_;
  VkDeviceSize reserved_ = 0;  ///< of staging, for the lists
  std::vector<gpu::Target> targetList_;
  std::vector<gpu::Placement> placementList_;
  std::vector<gpu::ClusterRef> refList_;
  std::vector<gpu::PairItem> itemList_;
  std::vector<gpu::State> stateList_;
  std::vector<MaskRecorder::Sides> sides_;  ///< of each target
};

}  // namespace radar
