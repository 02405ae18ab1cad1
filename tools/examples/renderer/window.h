// A window of constant size.
#pragma once

#include <memory>

#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

#include "renderer.h"

namespace example {

class Window {
 public:
  /// Of an instance that shall have windows.
  static std::vector<const char*> extensions() {
    uint32_t count = 0;
    const char** names = glfwInit() == GLFW_TRUE ? glfwGetRequiredInstanceExtensions(&count) : nullptr;
    if (names == nullptr) throw radar::Error("there is no display for a window, or no Vulkan for it");
    return {names, names + count};
  }

  Window(const Gpu& gpu, vk::Extent2D size) : gpu_(gpu) {
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_RESIZABLE, GLFW_FALSE);
    window_.reset(
        glfwCreateWindow(static_cast<int>(size.width), static_cast<int>(size.height), "Cyber Radar", nullptr, nullptr));
    VkSurfaceKHR surface;
    if (window_ == nullptr || glfwCreateWindowSurface(*gpu.instance, window_.get(), nullptr, &surface) != VK_SUCCESS)
      throw radar::Error("cannot open a window");
    surface_ = {gpu.instance, surface};
    if (!gpu.physical.getSurfaceSupportKHR(gpu.host.queueFamily, surface))
      throw radar::Error("the device cannot show pictures in this window");
    const vk::SurfaceCapabilitiesKHR can = gpu.physical.getSurfaceCapabilitiesKHR(surface);
    // The shaders have encoded the colours, so an sRGB format would do it twice.
    const std::vector<vk::SurfaceFormatKHR> formats = gpu.physical.getSurfaceFormatsKHR(surface);
    vk::SurfaceFormatKHR format = formats.at(0);
    for (const vk::SurfaceFormatKHR& has : formats)
      if (has.format == vk::Format::eB8G8R8A8Unorm || has.format == vk::Format::eR8G8B8A8Unorm) format = has;
    size_ = can.currentExtent.width == ~0u ? size : can.currentExtent;
    swapchain_ = gpu.device.createSwapchainKHR(
        {.surface = surface,
         .minImageCount = can.minImageCount + (can.maxImageCount == can.minImageCount ? 0 : 1),
         .imageFormat = format.format,
         .imageColorSpace = format.colorSpace,
         .imageExtent = size_,
         .imageArrayLayers = 1,
         .imageUsage = vk::ImageUsageFlagBits::eTransferDst,
         .preTransform = can.currentTransform,
         .compositeAlpha = vk::CompositeAlphaFlagBitsKHR::eOpaque,
         .presentMode = vk::PresentModeKHR::eFifo,
         .clipped = VK_TRUE});
    for (size_t i = 0; i < swapchain_.getImages().size(); ++i) drawn_.push_back(gpu.device.createSemaphore({}));
    for (vk::raii::Semaphore& semaphore : acquired_) semaphore = gpu.device.createSemaphore({});
  }
  ~Window() { gpu_.device.waitIdle(); }

  vk::Extent2D size() const { return size_; }
  bool isOpen() const {
    glfwPollEvents();
    return glfwWindowShouldClose(window_.get()) == GLFW_FALSE;
  }

  void show(Renderer& renderer) {
    const vk::Semaphore acquired = *acquired_[count_++ % acquired_.size()];
    const uint32_t index = swapchain_.acquireNextImage(UINT64_MAX, acquired).second;
    const vk::Image image = swapchain_.getImages()[index];
    const auto record = [&](const vk::raii::CommandBuffer& commands, vk::Image picture) {
      using Layout = vk::ImageLayout;
      barrier(commands, image, {kCopy.stages, 0}, Layout::eUndefined, kCopy, Layout::eTransferDstOptimal);
      const vk::ImageSubresourceLayers colour{vk::ImageAspectFlagBits::eColor, 0, 0, 1};
      const vk::Offset3D end{static_cast<int32_t>(size_.width), static_cast<int32_t>(size_.height), 1};
      const std::array<vk::Offset3D, 2> whole{vk::Offset3D{}, end};
      commands.blitImage(picture, Layout::eTransferSrcOptimal, image, Layout::eTransferDstOptimal,
                         vk::ImageBlit{colour, whole, colour, whole}, vk::Filter::eNearest);
      barrier(commands, image, kCopy, Layout::eTransferDstOptimal, {kCopy.stages, 0}, Layout::ePresentSrcKHR);
    };
    renderer.frame(record, acquired, *drawn_[index]);
    (void)gpu_.queue.presentKHR({.waitSemaphoreCount = 1,
                                 .pWaitSemaphores = &*drawn_[index],
                                 .swapchainCount = 1,
                                 .pSwapchains = &*swapchain_,
                                 .pImageIndices = &index});
  }

 private:
  const Gpu& gpu_;
  std::unique_ptr<GLFWwindow, void (*)(GLFWwindow*)> window_{nullptr, glfwDestroyWindow};
  vk::raii::SurfaceKHR surface_ = nullptr;
  vk::raii::SwapchainKHR swapchain_ = nullptr;
  vk::Extent2D size_;
  std::vector<vk::raii::Semaphore> drawn_;
  // A frame's semaphore is free again once the frame after the next has been submitted.
  std::array<vk::raii::Semaphore, kFramesInFlight + 1> acquired_{nullptr, nullptr, nullptr};
  uint32_t count_ = 0;
};

}  // namespace example
