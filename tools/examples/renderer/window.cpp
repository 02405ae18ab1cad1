#include "window.h"

#include <algorithm>

#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

#include "radar/error.h"

namespace example {

namespace {

[[noreturn]] void fail(const std::string& what) {
  const char* why = nullptr;
  glfwGetError(&why);
  throw radar::Error(what + (why == nullptr ? "" : std::string(": ") + why));
}

VkSemaphore makeSemaphore(const Gpu& gpu, Lifetime& lifetime) {
  const VkSemaphoreCreateInfo info{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
  VkSemaphore semaphore;
  require(vkCreateSemaphore(gpu.device, &info, nullptr, &semaphore), "vkCreateSemaphore");
  lifetime.add(gpu.device, semaphore, vkDestroySemaphore);
  return semaphore;
}

}  // namespace

Window::Window(VkExtent2D size) {
  if (glfwInit() == GLFW_FALSE) fail("there is no display for a window (use --headless)");
  if (glfwVulkanSupported() == GLFW_FALSE) fail("there is no Vulkan for windows");
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  window_ =
      glfwCreateWindow(static_cast<int>(size.width), static_cast<int>(size.height), "Cyber Radar", nullptr, nullptr);
  if (window_ == nullptr) fail("cannot open a window");
  glfwSetWindowUserPointer(window_, this);
  glfwSetScrollCallback(window_, [](GLFWwindow* window, double, double by) {
    auto& self = *static_cast<Window*>(glfwGetWindowUserPointer(window));
    self.zoom = std::clamp(self.zoom * (1 - 0.1 * by), 0.1, 3.0);
  });
  glfwSetCursorPosCallback(window_, [](GLFWwindow* window, double x, double y) {
    auto& self = *static_cast<Window*>(glfwGetWindowUserPointer(window));
    if (glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS) {
      self.yaw -= 0.005 * (x - self.x_);
      self.pitch = std::clamp(self.pitch + 0.005 * (y - self.y_), 0.02, 1.5);
    }
    self.x_ = x;
    self.y_ = y;
  });
  glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int) {
    auto& self = *static_cast<Window*>(glfwGetWindowUserPointer(window));
    if (action == GLFW_RELEASE) return;
    if (key == GLFW_KEY_SPACE) self.paused = !self.paused;
    if (key == GLFW_KEY_S) self.step = self.paused = true;
    if (key == GLFW_KEY_M) self.lines = static_cast<Lines>((static_cast<int>(self.lines) + 1) % 3);
    if (key == GLFW_KEY_ESCAPE) glfwSetWindowShouldClose(window, GLFW_TRUE);
  });
}

Window::~Window() {
  glfwTerminate();
}

std::vector<const char*> Window::instanceExtensions() const {
  uint32_t count = 0;
  const char** names = glfwGetRequiredInstanceExtensions(&count);
  if (names == nullptr) fail("Vulkan has no extensions for windows");
  return {names, names + count};
}

void Window::setTitle(const std::string& title) {
  glfwSetWindowTitle(window_, title.c_str());
}

VkExtent2D Window::size() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  return {static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
}

bool Window::poll() {
  glfwPollEvents();
  while (size().width == 0 && glfwWindowShouldClose(window_) == GLFW_FALSE) glfwWaitEvents();  // minimised
  return glfwWindowShouldClose(window_) == GLFW_FALSE;
}

Swapchain::Swapchain(const Gpu& gpu, const Window& window) : gpu_(gpu), window_(window) {
  require(glfwCreateWindowSurface(gpu.instance, window.window_, nullptr, &surface_), "glfwCreateWindowSurface");
  lifetime_.add([this] { vkDestroySurfaceKHR(gpu_.instance, surface_, nullptr); });
  VkBool32 supported = VK_FALSE;
  require(vkGetPhysicalDeviceSurfaceSupportKHR(gpu.physical, gpu.family, surface_, &supported),
          "vkGetPhysicalDeviceSurfaceSupportKHR");
  if (supported == VK_FALSE) throw radar::Error(gpu.name + " cannot show pictures in this window");
  for (VkSemaphore& semaphore : acquired_) semaphore = makeSemaphore(gpu, lifetime_);
  make();
}

Swapchain::~Swapchain() {
  vkDeviceWaitIdle(gpu_.device);
}

void Swapchain::make() {
  require(vkDeviceWaitIdle(gpu_.device), "vkDeviceWaitIdle");
  sized_.end();
  VkSurfaceCapabilitiesKHR can;
  require(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(gpu_.physical, surface_, &can),
          "vkGetPhysicalDeviceSurfaceCapabilitiesKHR");
  uint32_t count = 0;
  require(vkGetPhysicalDeviceSurfaceFormatsKHR(gpu_.physical, surface_, &count, nullptr),
          "vkGetPhysicalDeviceSurfaceFormatsKHR");
  std::vector<VkSurfaceFormatKHR> formats(count);
  require(vkGetPhysicalDeviceSurfaceFormatsKHR(gpu_.physical, surface_, &count, formats.data()),
          "vkGetPhysicalDeviceSurfaceFormatsKHR");
  VkSurfaceFormatKHR format =
      formats.at(0);  // the shaders have encoded the colours, so an sRGB format would do it twice
  for (const VkSurfaceFormatKHR& has : formats)
    if (has.format == VK_FORMAT_B8G8R8A8_UNORM || has.format == VK_FORMAT_R8G8B8A8_UNORM) format = has;
  const VkExtent2D wanted = can.currentExtent.width == ~0u ? window_.size() : can.currentExtent;
  size_ = {std::clamp(wanted.width, can.minImageExtent.width, can.maxImageExtent.width),
           std::clamp(wanted.height, can.minImageExtent.height, can.maxImageExtent.height)};
  const VkSwapchainCreateInfoKHR info{.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
                                      .surface = surface_,
                                      .minImageCount = can.maxImageCount == 0
                                                           ? can.minImageCount + 1
                                                           : std::min(can.minImageCount + 1, can.maxImageCount),
                                      .imageFormat = format.format,
                                      .imageColorSpace = format.colorSpace,
                                      .imageExtent = size_,
                                      .imageArrayLayers = 1,
                                      .imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                      .preTransform = can.currentTransform,
                                      .compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR,
                                      .presentMode = VK_PRESENT_MODE_FIFO_KHR,
                                      .clipped = VK_TRUE};
  require(vkCreateSwapchainKHR(gpu_.device, &info, nullptr, &swapchain_), "vkCreateSwapchainKHR");
  sized_.add(gpu_.device, swapchain_, vkDestroySwapchainKHR);
  require(vkGetSwapchainImagesKHR(gpu_.device, swapchain_, &count, nullptr), "vkGetSwapchainImagesKHR");
  images_.resize(count);
  require(vkGetSwapchainImagesKHR(gpu_.device, swapchain_, &count, images_.data()), "vkGetSwapchainImagesKHR");
  drawn_.clear();
  for (uint32_t i = 0; i < count; ++i) drawn_.push_back(makeSemaphore(gpu_, sized_));
}

std::optional<Output> Swapchain::acquire() {
  const VkSemaphore acquired = acquired_[count_ % kSemaphores];
  VkResult result = VK_ERROR_OUT_OF_DATE_KHR;
  const VkExtent2D now = window_.size();
  if (now.width == size_.width && now.height == size_.height)
    result = vkAcquireNextImageKHR(gpu_.device, swapchain_, UINT64_MAX, acquired, VK_NULL_HANDLE, &image_);
  if (result == VK_ERROR_OUT_OF_DATE_KHR) {
    make();
    return std::nullopt;
  }
  require(result, "vkAcquireNextImageKHR");
  ++count_;
  const auto record = [this](VkCommandBuffer commands, VkImage picture) {
    barrier(commands, images_[image_], {kBlitted.stage, VK_ACCESS_2_NONE}, VK_IMAGE_LAYOUT_UNDEFINED, kBlitted,
            VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    const auto width = static_cast<int32_t>(size_.width), height = static_cast<int32_t>(size_.height);
    const VkImageSubresourceLayers colour{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    const VkImageBlit whole{colour, {{}, {width, height, 1}}, colour, {{}, {width, height, 1}}};
    vkCmdBlitImage(commands, picture, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, images_[image_],
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &whole, VK_FILTER_NEAREST);
    barrier(commands, images_[image_], kBlitted, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
            {kBlitted.stage, VK_ACCESS_2_NONE}, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
  };
  return Output{.record = record, .acquired = acquired, .drawn = drawn_[image_]};
}

void Swapchain::present() {
  const VkPresentInfoKHR info{.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                              .waitSemaphoreCount = 1,
                              .pWaitSemaphores = &drawn_[image_],
                              .swapchainCount = 1,
                              .pSwapchains = &swapchain_,
                              .pImageIndices = &image_};
  const VkResult result = vkQueuePresentKHR(gpu_.queue, &info);
  if (result != VK_ERROR_OUT_OF_DATE_KHR) require(result, "vkQueuePresentKHR");  // acquire() will see it, too
}

}  // namespace example
