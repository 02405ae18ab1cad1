// Frames: the agents ask, the engine answers, the agents move, and all is drawn, in one command buffer.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "agents.h"
#include "gpu.h"
#include "world.h"

namespace example {

struct Camera {
  mat4 clipFromWorld;
  vec3 eye;
};
/// Looks from `eye` at `target`.
Camera lookAt(const vec3& eye, const vec3& target, float aspect);

/// Where a frame goes.
struct Output {
  /// Copies or blits the picture, which is in TRANSFER_SRC_OPTIMAL.
  std::function<void(VkCommandBuffer, VkImage)> record{};
  std::function<void()> done{};  ///< called when all that has executed
  bool check = false;            ///< the agents, also if it is not the turn of this frame
  VkSemaphore acquired = VK_NULL_HANDLE, drawn = VK_NULL_HANDLE;
};

enum class Lines { none, contacts, normals };

/// What the device has measured and the CPU has checked.
struct Report {
  static constexpr const char* kStages[] = {"write queries", "search", "read and move", "draw", "copy out"};
  std::array<std::vector<double>, 5> milliseconds;  ///< one number a frame and stage
  std::vector<double> whole;                        ///< of a frame's commands
  uint32_t checks = 0, crossings = 0;
  uint32_t answered = 0, refused = 0;  ///< queries, and those without an answer
};

class Renderer {
 public:
  /// Draws a frame that nobody sees, too.
  Renderer(const Gpu& gpu, World& world, VkExtent2D size, const radar::OnProgress& onProgress);
  ~Renderer();
  /// Waits until the device is done, and makes the images anew.
  void resize(VkExtent2D size);
  /// Records and submits a frame, in which agents move if `moves`.
  void frame(const Camera& camera, bool moves, Lines lines, const Output& output);
  /// Waits for all frames; their reports are then complete.
  void finish();
  VkExtent2D size() const { return size_; }
  const Report& report() const { return report_; }
  radar::MemoryUse engineMemory() const { return agents_.memoryUse(); }
  uint32_t frames() const { return frames_; }

 private:
  struct Slot {
    VkCommandBuffer commands;
    VkFence fence;
    VkQueryPool times;
    bool pending = false, moved = false, checked = false;
    std::function<void()> done;
  };

  void makeSlot(Slot& slot);
  void draw(VkCommandBuffer commands, uint32_t slot, Lines lines);
  void wait(uint32_t index);

  const Gpu& gpu_;
  const World& world_;
  Lifetime lifetime_, images_;
  Agents agents_;
  VkExtent2D size_{};
  Image samples_, depth_, picture_;
  Buffer indices_;
  VkPipeline mesh_, line_;
  std::array<Slot, kFramesInFlight> slots_;
  uint32_t frames_ = 0;
  Report report_;
};

}  // namespace example
