// A window, what its user does there, and the pictures that it shows.
#pragma once

#include <optional>

#include "renderer.h"

struct GLFWwindow;

namespace example {

/// The user turns the view by dragging, zooms by scrolling; space pauses, S makes a step, M shows other lines.
class Window {
 public:
  explicit Window(VkExtent2D size);
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
  ~Window();
  std::vector<const char*> instanceExtensions() const;
  void setTitle(const std::string& title);
  VkExtent2D size() const;
  /// Reads events; false once the user has closed the window.
  bool poll();

  double yaw = 0.6, pitch = 0.55, zoom = 1;
  bool paused = false, step = false;
  Lines lines = Lines::none;

 private:
  friend class Swapchain;
  GLFWwindow* window_;
  double x_ = 0, y_ = 0;
};

class Swapchain {
 public:
  /// Throws radar::Error if the device cannot show pictures in the window.
  Swapchain(const Gpu& gpu, const Window& window);
  ~Swapchain();
  /// Where the next frame goes; none if the window has another size now, for which it is prepared then.
  std::optional<Output> acquire();
  /// Shows the frame, which has been submitted.
  void present();
  VkExtent2D size() const { return size_; }

 private:
  void make();

  // A frame's semaphore is free again once the frame after the next has been submitted.
  static constexpr size_t kSemaphores = 3;

  const Gpu& gpu_;
  const Window& window_;
  Lifetime lifetime_, sized_;
  VkSurfaceKHR surface_;
  VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
  VkExtent2D size_{};
  std::vector<VkImage> images_;
  std::vector<VkSemaphore> drawn_;
  std::array<VkSemaphore, kSemaphores> acquired_;
  uint32_t count_ = 0, image_ = 0;
};

}  // namespace example
