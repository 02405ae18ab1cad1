// Devices without enough memory: the tests make the engine's allocations fail. Queries are answered even so.
#include <algorithm>
#include <bit>
#include <limits>

#include "gpu/buffer.h"
#include "support/catch.h"
#include "support/same_bits.h"
#include "support/test_device.h"
#include "support/world.h"
#include "workloads/generate.h"

namespace {

using namespace radar;
using test::differenceOf;

/// Makes calls of the device fail for lack of memory.
class ScarceMemory {
 public:
  ScarceMemory() : device_(test::device().impl()) {
    allocateMemory = device_.vk.AllocateMemory;
    queueSubmit = device_.vk.QueueSubmit2;
    most = std::numeric_limits<VkDeviceSize>::max();
    failing = -1;
    calls = 0;
    device_.vk.AllocateMemory = [](VkDevice device, const VkMemoryAllocateInfo* info,
                                   const VkAllocationCallbacks* allocator, VkDeviceMemory* memory) {
      const bool fails = calls++ == failing || info->allocationSize > most;
      return fails ? VK_ERROR_OUT_OF_DEVICE_MEMORY : allocateMemory(device, info, allocator, memory);
    };
    device_.vk.QueueSubmit2 = [](VkQueue queue, uint32_t count, const VkSubmitInfo2* infos, VkFence fence) {
      return calls++ == failing ? VK_ERROR_OUT_OF_HOST_MEMORY : queueSubmit(queue, count, infos, fence);
    };
  }
  ~ScarceMemory() {
    device_.vk.AllocateMemory = allocateMemory;
    device_.vk.QueueSubmit2 = queueSubmit;
  }
  ScarceMemory(const ScarceMemory&) = delete;
  ScarceMemory& operator=(const ScarceMemory&) = delete;

  inline static VkDeviceSize most;   ///< larger allocations fail
  inline static int failing, calls;  ///< the number of the call that fails, of both kinds together; and calls so far

 private:
  inline static PFN_vkAllocateMemory allocateMemory;
  inline static PFN_vkQueueSubmit2 queueSubmit;
  Device::Impl& device_;
};

constexpr SweeperOptions kOnDevice{.cpuBatch = 0};

// Teapots among boxes, and their answers.
struct Teapots : test::Case {
  Teapots(uint32_t sensors, Mode asked)
      : test::Case(test::caseOf(tools::makeWorkload(tools::Table1{.boxes = 10'000, .sensors = sensors}), 128)),
        mode(asked) {
    answers = Sweeper(test::device(), scene, kOnDevice).run(queries, mode).results;
  }
  Mode mode;
  std::vector<Result> answers;
};

}  // namespace

TEST_CASE("a Sweeper whose first batch finds no memory on the device says so in the answers") {
  const Teapots teapots(24, Mode::sampled);
  const ScarceMemory scarce;
  ScarceMemory::most = 0;
  Sweeper sweeper(test::device(), teapots.scene, kOnDevice);
  const Answers answers = sweeper.run(teapots.queries, teapots.mode);
  CHECK_FALSE(answers.reasons.empty());
  for (const auto& [i, reason] : answers.reasons) CHECK(answers.results[i].status == Status::invalid);
}

TEST_CASE("queries of mode contact that do not fit the device's memory are answered on the CPU, later ones there") {
  const Teapots teapots(64, Mode::contact);
  Sweeper sweeper(test::device(), teapots.scene, kOnDevice);
  {
    const ScarceMemory scarce;
    ScarceMemory::most = 1u << 16;
    CHECK_NOTHROW(sweeper.sync());
    const Answers answers = sweeper.run(teapots.queries, teapots.mode);
    CHECK(differenceOf(answers.results, teapots.answers) == "");
    CHECK(answers.stats.cpuQueries == teapots.queries.size());
    CHECK(answers.reasons.empty());
  }
  const Answers answers = sweeper.run(teapots.queries, teapots.mode);
  CHECK(differenceOf(answers.results, teapots.answers) == "");
  CHECK(answers.stats.submissions > 0);
  CHECK(answers.stats.cpuQueries == 0);
}

TEST_CASE("lists of hits do not change if the device runs out of memory") {
  Teapots teapots(64, Mode::contact);
  for (size_t i = 0; i < teapots.queries.size(); i += 3) teapots.queries[i].hits = 4;
  Sweeper sweeper(test::device(), teapots.scene, kOnDevice);
  const Answers expected = sweeper.run(teapots.queries, teapots.mode);
  Sweeper poor(test::device(), teapots.scene, kOnDevice);
  const ScarceMemory scarce;
  ScarceMemory::most = 1u << 16;
  const Answers found = poor.run(teapots.queries);
  CHECK(differenceOf(found, expected) == "");
}

TEST_CASE("a batch of mode sampled whose pictures do not fit the device's memory is split") {
  const Teapots teapots(64, Mode::sampled);
  Sweeper sweeper(test::device(), teapots.scene);
  sweeper.run(std::span(teapots.queries).first(1), teapots.mode);  // uploads the scene
  const ScarceMemory scarce;
  ScarceMemory::most = 20 * 128 * 128 * sizeof(float);
  const Answers answers = sweeper.run(teapots.queries, teapots.mode);
  CHECK(differenceOf(answers.results, teapots.answers) == "");
  CHECK(answers.stats.submissions >= 4);
  CHECK(answers.reasons.empty());
}

TEST_CASE("a query of mode sampled whose own picture does not fit the device's memory is invalid, and no other is") {
  Teapots teapots(24, Mode::sampled);
  const auto drawn = std::ranges::find(teapots.answers, Tier::sampled, &Result::tier);
  REQUIRE(drawn != teapots.answers.end());
  const auto large = static_cast<size_t>(drawn - teapots.answers.begin());
  teapots.queries[large].resolution = 512;
  Sweeper sweeper(test::device(), teapots.scene);
  sweeper.run(std::span(teapots.queries).first(1), teapots.mode);
  const ScarceMemory scarce;
  ScarceMemory::most = 26 * 128 * 128 * sizeof(float) / 2;
  const Answers found = sweeper.run(teapots.queries, teapots.mode);
  for (size_t i = 0; i < found.results.size(); ++i) {
    CAPTURE(i);
    if (i == large) {
      CHECK(found.results[i].status == Status::invalid);
      CHECK_THAT(found.reasons.at(i), test::Contains("VK_ERROR_OUT_OF_DEVICE_MEMORY"));
    } else {
      CHECK(test::sameBits(found.results[i], teapots.answers[i]));
    }
  }
  CHECK(found.reasons.size() == 1);
}

TEST_CASE("whichever allocation or submission fails for lack of memory, every query has its answer") {
  const Teapots teapots(20, GENERATE(Mode::contact, Mode::sampled));
  const std::span<const Query> first = std::span(teapots.queries).first(2);
  int failed = 0;
  for (int failing = 0;; ++failing) {
    CAPTURE(failing);
    Sweeper sweeper(test::device(), teapots.scene, kOnDevice);
    sweeper.run(first, teapots.mode);  // makes the mode ready
    const ScarceMemory scarce;
    ScarceMemory::failing = failing;
    const Answers answers = sweeper.run(teapots.queries, teapots.mode);
    CHECK(differenceOf(answers.results, teapots.answers) == "");
    CHECK(answers.reasons.empty());
    CHECK(differenceOf(sweeper.run(teapots.queries, teapots.mode).results, teapots.answers) == "");
    if (ScarceMemory::calls <= failing) break;
    ++failed;
  }
  CHECK(failed > 5);
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("a buffer takes at most a quarter more memory than asked for, or half if it grows a little, in few steps") {
  const auto made = [] {
    return gpu::Buffer(test::device().impl(), "grown", gpu::BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  };
  for (VkDeviceSize bytes = 5000; bytes < 10'000'000; bytes += bytes / 7) {
    gpu::Buffer buffer = made();
    CHECK(buffer.reserve(bytes));
    REQUIRE(buffer.capacity() >= bytes);
    REQUIRE(4 * buffer.capacity() <= 5 * bytes);
  }
  gpu::Buffer buffer = made();
  int steps = 0;
  for (VkDeviceSize bytes = 2000; bytes < 1u << 20; bytes += 100) {
    steps += buffer.reserve(bytes);
    REQUIRE(buffer.capacity() >= bytes);
    REQUIRE(2 * buffer.capacity() <= 3 * bytes + 2 * 256);
  }
  CHECK(steps <= 20);
}

TEST_CASE("lavapipe compiles a kernel once, whatever the sizes of its texel buffers") {
  for (VkDeviceSize bytes = 0; bytes < 10'000'000; bytes += 1 + bytes / 9) {
    for (const VkDeviceSize asked : {bytes, std::bit_floor(bytes), gpu::roundedUp(bytes, 1u << 16)}) {
      gpu::Buffer texels(test::device().impl(), "texels", gpu::BufferDomain::device, gpu::kAsTexels);
      texels.reserve(asked);
      REQUIRE(texels.capacity() >= asked);
      REQUIRE_FALSE(std::has_single_bit(texels.capacity()));
      REQUIRE(texels.capacity() % (1u << 16) >= 256);
    }
  }
}
