// The agents on the device, and the engine that answers them: all that a renderer adds to its frames to ask how far
// something may move.
#pragma once

#include <array>
#include <optional>

#include "gpu.h"
#include "radar/recorder.h"
#include "world.h"

namespace example {

inline constexpr uint32_t kFramesInFlight = 2;

/// `slot`, in all calls: which of the frames in flight is recorded; its last one has executed and been waited for.
class Agents {
 public:
  Agents(const Gpu& gpu, World& world, const radar::OnProgress& onProgress);

  /// A step is these three, one after another. The agents claim room, and those that may move write their queries.
  void ask(VkCommandBuffer commands, uint32_t slot);
  /// The engine answers.
  void search(VkCommandBuffer commands, uint32_t slot);
  /// The agents read the answers and move.
  void move(VkCommandBuffer commands, uint32_t slot);

  /// Copies to the CPU what check() needs, which is called when that has executed.
  void readBack(VkCommandBuffer commands, uint32_t slot);
  struct Check {
    uint32_t crossings = 0;
    uint32_t answered = 0, refused = 0;  ///< queries so far, and those without an answer
  };
  /// Counts agents that touch or cross anything. The scene learns where they have gone, which keeps the search fast.
  Check check(uint32_t slot);

  /// What the engine holds on the device.
  radar::MemoryUse memoryUse() const { return device_.memoryUse(); }
  VkPipelineLayout layout() const { return layout_; }
  void bind(VkCommandBuffer commands, uint32_t slot, VkPipelineBindPoint point, VkPipeline pipeline) const;

  Push push{};  ///< the constants of all shaders

 private:
  struct Slot {
    std::optional<radar::Recorder> recorder;
    VkDescriptorSet set;
    Buffer transforms, skinned, agents, counts;  ///< read back
    uint32_t step = 0;
  };

  void makeBuffers();
  void makeLayout();
  void makeSlot(Slot& slot);
  radar::HostGeometry geometry() const { return {.meshes = deformed_, .objects = {&places_, 1}}; }
  void dispatch(VkCommandBuffer commands, uint32_t slot, VkPipeline pipeline, uint32_t invocations) const;

  const Gpu& gpu_;
  World& world_;
  Lifetime lifetime_;
  radar::Device device_;
  radar::SceneCopy copy_;
  std::array<Buffer, kBindings> buffers_;
  VkDescriptorSetLayout setLayout_;
  VkPipelineLayout layout_;
  VkPipeline skin_, claim_, ask_, move_;
  std::array<Slot, kFramesInFlight> slots_;
  // What the device writes, and the engine reads: where all agents are, two meshes of each walker, and the queries.
  std::vector<radar::ObjectId> moved_;
  radar::MovedObjects places_;
  std::vector<radar::DeformedMesh> deformed_;
  radar::HostQueries queries_;
};

}  // namespace example
