// Agents that never touch: they fly through a city, and ask before each move how far it is free. Queries, search, moves
// and drawing are one command buffer on the host's Vulkan device; no answer comes to the CPU.
//   radar-example-renderer AGENTS [FRAMES [FOLDER]]    with a folder, for a picture of each fiftieth frame: no window
#include <cstdio>
#include <stdexcept>
#include <string>

#include <png.h>

#include "window.h"

namespace {

using namespace example;

constexpr vk::Extent2D kSize{960, 540};
constexpr uint32_t kPictureEvery = 50;

void runHeadless(uint32_t agents, uint32_t frames, const std::string& folder) {
  World world(agents);
  const Gpu gpu({});
  Renderer renderer(gpu, world, kSize);
  const Buffer pixels = makeBuffer(gpu, 4 * kSize.width * kSize.height, vk::BufferUsageFlagBits::eTransferDst);
  const auto copy = [&](const vk::raii::CommandBuffer& commands, vk::Image image) {
    const vk::BufferImageCopy whole{.imageSubresource = {vk::ImageAspectFlagBits::eColor, 0, 0, 1},
                                    .imageExtent = {kSize.width, kSize.height, 1}};
    commands.copyImageToBuffer(image, vk::ImageLayout::eTransferSrcOptimal, *pixels.handle, whole);
    barrier(commands, kCopy, kCpu);
  };
  png_image png{nullptr, PNG_IMAGE_VERSION, kSize.width, kSize.height, PNG_FORMAT_RGBA, 0, 0, 0, {}};
  for (uint32_t frame = 1; frame <= frames; ++frame) {
    const bool isShown = frame % kPictureEvery == 0;
    renderer.frame(isShown ? Output(copy) : Output());
    if (!isShown) continue;
    gpu.device.waitIdle();
    const std::string path = folder + "/frame-" + std::to_string(frame) + ".png";
    if (png_image_write_to_file(&png, path.c_str(), 0, pixels.mapped, 0, nullptr) == 0)
      throw radar::Error(path + ": " + png.message);
  }
  renderer.finish();
}

void runWindow(uint32_t agents, uint32_t frames) {
  World world(agents);
  const Gpu gpu(Window::extensions());
  Window window(gpu, kSize);
  Renderer renderer(gpu, world, window.size());
  for (uint32_t frame = 0; frame < frames && window.isOpen(); ++frame) window.show(renderer);
  renderer.finish();
}

}  // namespace

int main(int count, char** arguments) try {
  const auto number = [&](int i) { return static_cast<uint32_t>(std::stoul(count > i ? arguments[i] : "")); };
  const uint32_t agents = number(1), frames = count > 2 ? number(2) : ~0u;
  if (agents < 1 || agents > 100000 || count > 4) throw std::out_of_range("main");
  count > 3 ? runHeadless(agents, frames, arguments[3]) : runWindow(agents, frames);
} catch (const std::logic_error&) {
  std::fputs("radar-example-renderer: expected AGENTS (1 to 100000) [FRAMES [FOLDER]]\n", stderr);
  return 2;
} catch (const std::exception& error) {
  std::fprintf(stderr, "radar-example-renderer: %s\n", error.what());
  return 2;
}
