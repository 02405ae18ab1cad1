// Agents that never touch: they fly and walk through a city, and ask before each move how far it is free. Queries,
// search, moves and drawing are one command buffer on the host's Vulkan device; no answer comes to the CPU.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iterator>
#include <utility>

#include "film.h"
#include "radar/error.h"
#include "renderer.h"
#include "window.h"

namespace example {

namespace {

constexpr const char* kUsage = R"(radar-example-renderer [OPTION...]
  --agents N      how many, 1 to 100000 (10000)
  --size WxH      of the picture, at least 64x64 (1280x720)
  --show WHAT     nothing, contacts (where agents will touch something first), or normals there, too
  --frames N      ends after that many
  --headless      opens no window; needs --frames and --out
  --out DIR       for pictures, PNG, and a film of every second frame, GIF
  --every N       a picture each N frames (50)
In the window: drag to turn, scroll to zoom, space pauses, S makes a step, M shows other lines, Escape ends.
)";

struct Options {
  uint32_t agents = 10000, frames = 0, every = 50;
  VkExtent2D size{1280, 720};
  Lines lines = Lines::none;
  bool headless = false;
  std::filesystem::path out;
};

uint32_t numberIn(std::string_view text, std::string_view option, uint32_t least, uint32_t most) {
  uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value < least || value > most) {
    throw radar::Error(std::string(option) + ": expected a number from " + std::to_string(least) + " to " +
                       std::to_string(most) + ", got \"" + std::string(text) + "\"");
  }
  return value;
}

Options parse(std::span<char*> arguments) {
  Options options;
  for (size_t i = 1; i < arguments.size(); ++i) {
    const std::string_view option = arguments[i];
    const auto value = [&]() -> std::string_view {
      if (i + 1 == arguments.size()) throw radar::Error(std::string(option) + " needs a value");
      return arguments[++i];
    };
    if (option == "--headless") {
      options.headless = true;
    } else if (option == "--agents") {
      options.agents = numberIn(value(), option, 1, 100000);
    } else if (option == "--frames") {
      options.frames = numberIn(value(), option, 1, 1000000);
    } else if (option == "--every") {
      options.every = numberIn(value(), option, 1, 1000000);
    } else if (option == "--out") {
      options.out = value();
    } else if (option == "--size") {
      const std::string_view size = value();
      const size_t x = std::min(size.find('x'), size.size());
      options.size = {numberIn(size.substr(0, x), option, 64, 8192),
                      numberIn(size.substr(std::min(x + 1, size.size())), option, 64, 8192)};
    } else if (option == "--show") {
      const std::string_view what = value();
      constexpr std::string_view kLines[] = {"nothing", "contacts", "normals"};
      const auto* found = std::find(std::begin(kLines), std::end(kLines), what);
      if (found == std::end(kLines))
        throw radar::Error("--show: expected nothing, contacts or normals, got \"" + std::string(what) + "\"");
      options.lines = static_cast<Lines>(found - std::begin(kLines));
    } else {
      throw radar::Error("unknown option \"" + std::string(option) + "\"\n" + kUsage);
    }
  }
  if (options.headless && (options.frames == 0 || options.out.empty()))
    throw radar::Error("--headless needs --frames and --out");
  if (!options.headless && !options.out.empty()) throw radar::Error("--out needs --headless");
  return options;
}

/// A camera on a boom: closer to its target where something of the city is in between.
class Boom {
 public:
  explicit Boom(World& world) : world_(world) {}
  Camera look(double yaw, double pitch, double distance, VkExtent2D size) {
    const vec3 target{0, 0, 5};
    const auto at = [&](double far) {
      return vec3{static_cast<float>(target[0] + far * std::cos(pitch) * std::cos(yaw)),
                  static_cast<float>(target[1] + far * std::cos(pitch) * std::sin(yaw)),
                  static_cast<float>(target[2] + far * std::sin(pitch))};
    };
    // Comes closer at once, and goes back slowly.
    length_ = std::min(world_.boom(target, at(distance)), length_ + 0.02 * distance);
    return lookAt(at(length_), target, static_cast<float>(size.width) / static_cast<float>(size.height));
  }

 private:
  World& world_;
  double length_ = 1e9;
};

/// How far away the camera is if the user has not zoomed.
double distanceOf(const World& world) {
  return std::min(1.1 * world.half, 60.0);
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void print(const Renderer& renderer, const Gpu& gpu, const World& world) {
  const Report& report = renderer.report();
  std::printf("%zu agents, %u of them walkers, on %s; medians of %zu frames\n", world.agents.size(), world.walkers,
              gpu.name.c_str(), report.whole.size());
  for (size_t i = 0; i < std::size(Report::kStages); ++i)
    std::printf("  %-14s %9.2f ms, first %9.2f ms\n", Report::kStages[i], median(report.milliseconds[i]),
                report.milliseconds[i].empty() ? 0 : report.milliseconds[i].front());
  std::printf("  %-14s %9.2f ms, first %9.2f ms\n", "all", median(report.whole),
              report.whole.empty() ? 0 : report.whole.front());
  const radar::MemoryUse memory = renderer.engineMemory();
  std::printf("memory of the engine: %.1f MB used of %.1f MB in %u allocations\n",
              1e-6 * static_cast<double>(memory.used), 1e-6 * static_cast<double>(memory.allocated),
              memory.allocations);
  std::printf("queries: %u, without an answer: %u\n", report.answered, report.refused);
  std::printf("checks by the CPU: %u, crossings: %u\n", report.checks, report.crossings);
}

void runHeadless(const Options& options) {
  std::error_code error;
  std::filesystem::create_directories(options.out, error);
  if (error) throw radar::Error("cannot make the folder " + options.out.string() + ": " + error.message());
  Film film(options.out / "film.gif", options.size.width, options.size.height);

  World world(options.agents);
  const Gpu gpu({});
  Lifetime lifetime;
  std::array<Buffer, kFramesInFlight> pictures;
  const VkDeviceSize bytes = VkDeviceSize{4} * options.size.width * options.size.height;
  for (Buffer& picture : pictures)
    picture = makeBuffer(gpu, lifetime, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, Where::host);
  Renderer renderer(gpu, world, options.size, {});
  Boom boom(world);
  for (uint32_t frame = 0; frame < options.frames; ++frame) {
    const Camera camera = boom.look(0.6 + 0.002 * frame, 0.5, distanceOf(world), options.size);
    const Buffer& picture = pictures[frame % kFramesInFlight];
    const auto record = [&](VkCommandBuffer commands, VkImage image) {
      const VkBufferImageCopy whole{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                    .imageExtent = {options.size.width, options.size.height, 1}};
      vkCmdCopyImageToBuffer(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, picture.handle, 1, &whole);
      barrier(commands, kCopied, kHostRead);
    };
    const auto save = [&, frame] {
      const std::span<const std::byte> pixels(picture.mapped, bytes);
      if (frame % 2 == 0) film.add(pixels);
      if (frame % options.every != 0) return;
      char name[32];
      std::snprintf(name, sizeof(name), "frame-%06u.png", frame);
      writePicture(options.out / name, pixels, options.size.width, options.size.height);
    };
    Output output{.check = frame + 1 == options.frames};
    if (frame % 2 == 0 || frame % options.every == 0) {
      output.record = record;
      output.done = save;
    }
    renderer.frame(camera, true, options.lines, output);
  }
  renderer.finish();
  film.close();
  print(renderer, gpu, world);
}

void runWindow(const Options& options) {
  Window window(options.size);
  window.lines = options.lines;
  World world(options.agents);
  const std::vector<const char*> extensions = window.instanceExtensions();
  const Gpu gpu(extensions);
  Swapchain swapchain(gpu, window);
  Renderer renderer(gpu, world, swapchain.size(), [&](uint32_t done, uint32_t all, const std::string& next) {
    window.setTitle("Cyber Radar: " + std::to_string(done) + " of " + std::to_string(all) + ", " + next);
  });
  Boom boom(world);
  while (window.poll() && (options.frames == 0 || renderer.frames() < options.frames)) {
    std::optional<Output> output = swapchain.acquire();
    if (!output) {
      renderer.resize(swapchain.size());
      continue;
    }
    output->check = renderer.frames() + 1 == options.frames;
    const Camera camera = boom.look(window.yaw, window.pitch, window.zoom * distanceOf(world), swapchain.size());
    renderer.frame(camera, !window.paused || std::exchange(window.step, false), window.lines, *output);
    swapchain.present();
    const Report& report = renderer.report();
    if (renderer.frames() % 20 == 0 && !report.whole.empty()) {
      char title[128];
      std::snprintf(title, sizeof(title), "Cyber Radar: %zu agents, %.1f ms a frame, search %.1f ms, crossings %u",
                    world.agents.size(), report.whole.back(), report.milliseconds[1].back(), report.crossings);
      window.setTitle(title);
    }
  }
  renderer.finish();
  print(renderer, gpu, world);
}

}  // namespace

}  // namespace example

int main(int count, char** arguments) try {
  if (count == 2 && std::strcmp(arguments[1], "--help") == 0) {
    std::fputs(example::kUsage, stdout);
    return 0;
  }
  const example::Options options = example::parse({arguments, static_cast<size_t>(count)});
  options.headless ? example::runHeadless(options) : example::runWindow(options);
  return 0;
} catch (const radar::Error& error) {
  std::fprintf(stderr, "radar-example-renderer: %s\n", error.what());
  for (const std::string& reason : error.reasons) std::fprintf(stderr, "  %s\n", reason.c_str());
  return 2;
} catch (const std::exception& error) {
  std::fprintf(stderr, "radar-example-renderer: %s\n", error.what());
  return 2;
}
