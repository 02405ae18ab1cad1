// Devices without enough memory: the tests make the engine's allocations fail. Queries are answered even so.
#include <algorithm>
#include <bit>
#include <limits>

#include "gpu/buffer.h"
#include "gpu/submission.h"
#include "radar/recorder.h"
#include "support/catch.h"
#include "support/pretended_gpu.h"
#include "support/same_bits.h"
#include "support/separate_allocations.h"
#include "support/test_device.h"
#include "support/world.h"
#include "workloads/generate.h"

namespace {

using namespace radar;
using test::differenceOf;

const Device& hostsDevice();

/// Makes calls of hostsDevice() fail for lack of memory.
class ScarceMemory {
 public:
  ScarceMemory() : device_(hostsDevice().impl()) {
    queueSubmit = device_.vk.QueueSubmit2;
    reset();
    device_.vk.QueueSubmit2 = [](VkQueue queue, uint32_t count, const VkSubmitInfo2* infos, VkFence fence) {
      return calls++ == failing ? VK_ERROR_OUT_OF_HOST_MEMORY : queueSubmit(queue, count, infos, fence);
    };
  }
  ~ScarceMemory() {
    device_.vk.QueueSubmit2 = queueSubmit;
    reset();
  }
  ScarceMemory(const ScarceMemory&) = delete;
  ScarceMemory& operator=(const ScarceMemory&) = delete;

  /// Larger allocations fail.
  inline static VkDeviceSize most = std::numeric_limits<VkDeviceSize>::max();
  /// The number of the call that fails, of both kinds together; and calls so far.
  inline static int failing = -1, calls = 0;

 private:
  static void reset() {
    most = std::numeric_limits<VkDeviceSize>::max();
    failing = -1;
    calls = 0;
  }
  inline static PFN_vkQueueSubmit2 queueSubmit;
  Device::Impl& device_;
};

// The tests' device, as of a host that gives each buffer and image an allocation of its own.
const Device& hostsDevice() {
  return test::onceInRun([] {
    HostDevice host = test::device().handles();
    host.memory = test::separateAllocations(host);
    host.memory.allocate = [give = host.memory.allocate](const MemoryRequest& request, MemoryPiece& piece) {
      const bool fails =
          ScarceMemory::calls++ == ScarceMemory::failing || request.requirements.size > ScarceMemory::most;
      return fails ? VK_ERROR_OUT_OF_DEVICE_MEMORY : give(request, piece);
    };
    return Device::adopt(host);
  });
}

/// A device of its own, whose blocks of memory can fail: as it is, or as if it were a GPU, with more types of memory.
class OwnMemory {
 public:
  explicit OwnMemory(bool isGpu)
      : device(Device::adopt(isGpu ? test::asGpu(test::device().handles()) : test::device().handles())) {
    allocateMemory = device.impl().vk.AllocateMemory;
    most = std::numeric_limits<VkDeviceSize>::max();
    failing = -1;
    calls = 0;
    device.impl().vk.AllocateMemory = [](VkDevice owner, const VkMemoryAllocateInfo* info,
                                         const VkAllocationCallbacks* allocator, VkDeviceMemory* memory) {
      const bool fails = calls++ == failing || info->allocationSize > most;
      return fails ? VK_ERROR_OUT_OF_DEVICE_MEMORY : allocateMemory(owner, info, allocator, memory);
    };
  }
  gpu::Buffer buffer(VkDeviceSize bytes) const {
    gpu::Buffer made(device.impl(), "mapped", gpu::BufferDomain::upload, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    made.reserve(bytes);
    return made;
  }
  Device device;

  inline static VkDeviceSize most;   ///< larger allocations fail
  inline static int failing, calls;  ///< the number of the allocation that fails, and allocations so far

 private:
  inline static PFN_vkAllocateMemory allocateMemory;
};

constexpr SweeperOptions kOnDevice{.cpuBatch = 0};

// Teapots among boxes, and their answers.
struct Teapots : test::Case {
  Teapots(uint32_t sensors, Mode asked)
      : test::Case(test::caseOf(tools::makeWorkload(tools::Table1{.boxes = 10'000, .sensors = sensors}), 128)),
        mode(asked) {
    answers = Sweeper(hostsDevice(), scene, kOnDevice).run(queries, mode).results;
  }
  Mode mode;
  std::vector<Result> answers;
};

}  // namespace

TEST_CASE("a Sweeper whose first batch finds no memory on the device says so in the answers") {
  const Teapots teapots(24, Mode::sampled);
  const ScarceMemory scarce;
  ScarceMemory::most = 0;
  Sweeper sweeper(hostsDevice(), teapots.scene, kOnDevice);
  const Answers answers = sweeper.run(teapots.queries, teapots.mode);
  CHECK_FALSE(answers.reasons.empty());
  for (const auto& [i, reason] : answers.reasons) CHECK(answers.results[i].status == Status::invalid);
}

TEST_CASE("queries of mode contact that do not fit the device's memory are answered on the CPU, later ones there") {
  const Teapots teapots(64, Mode::contact);
  Sweeper sweeper(hostsDevice(), teapots.scene, kOnDevice);
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
  Sweeper sweeper(hostsDevice(), teapots.scene, kOnDevice);
  const Answers expected = sweeper.run(teapots.queries, teapots.mode);
  Sweeper poor(hostsDevice(), teapots.scene, kOnDevice);
  const ScarceMemory scarce;
  ScarceMemory::most = 1u << 16;
  const Answers found = poor.run(teapots.queries);
  CHECK(differenceOf(found, expected) == "");
}

TEST_CASE("a batch of mode sampled whose pictures do not fit the device's memory is split") {
  const Teapots teapots(64, Mode::sampled);
  Sweeper sweeper(hostsDevice(), teapots.scene);
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
  Sweeper sweeper(hostsDevice(), teapots.scene);
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
    Sweeper sweeper(hostsDevice(), teapots.scene, kOnDevice);
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

TEST_CASE("buffers take few allocations, of which each has its own bytes, and give them back") {
  const OwnMemory memory(GENERATE(false, true));
  const MemoryUse before = memory.device.memoryUse();
  CHECK(before.used == 0);
  tools::Random random(11);
  std::vector<gpu::Buffer> buffers;
  const auto holds = [](const gpu::Buffer& buffer) {
    const auto* words = reinterpret_cast<const uint64_t*>(buffer.mapped());
    return std::all_of(words, words + buffer.capacity() / 8, [&](uint64_t x) { return x == buffer.identity(); });
  };
  int made = 0;
  for (int step = 0; step < 2000; ++step) {
    if (!buffers.empty() && random.below(5) < 2) {
      const size_t which = random.below(static_cast<uint32_t>(buffers.size()));
      REQUIRE(holds(buffers[which]));
      std::swap(buffers[which], buffers.back());
      buffers.pop_back();
    } else {
      buffers.push_back(memory.buffer(1 + (1u << random.below(step % 100 == 0 ? 22 : 16))));
      const gpu::Buffer& buffer = buffers.back();
      std::fill_n(reinterpret_cast<uint64_t*>(buffer.mapped()), buffer.capacity() / 8, buffer.identity());
      ++made;
    }
  }
  CHECK(std::ranges::all_of(buffers, holds));
  VkDeviceSize used = 0;
  for (const gpu::Buffer& buffer : buffers) used += buffer.capacity();
  const MemoryUse now = memory.device.memoryUse();
  CHECK(now.used == used);
  CHECK(now.allocated <= 3 * now.used);
  CHECK(20 * OwnMemory::calls < made);
  buffers.clear();
  CHECK(memory.device.memoryUse().used == 0);
  CHECK(memory.device.memoryUse().allocations == before.allocations);
}

TEST_CASE("a buffer may have memory of its own where a block finds none, and else says what it needed") {
  const OwnMemory memory(GENERATE(false, true));
  std::vector<gpu::Buffer> buffers;
  for (int i = 0; i < 3; ++i) buffers.push_back(memory.buffer(400'000));  // the first block is full
  OwnMemory::most = 500'000;
  for (int i = 0; i < 3; ++i) buffers.push_back(memory.buffer(400'000));
  CHECK(buffers.back().mapped() != nullptr);
  CHECK_THROWS_WITH(memory.buffer(600'000),
                    test::StartsWith("vkAllocateMemory (mapped, ") && test::Contains("VK_ERROR_OUT_OF_DEVICE_MEMORY"));
}

TEST_CASE(
    "whichever block finds no memory, every query has its answer, or in mode sampled a reason, and later its answer") {
  const Teapots teapots(20, GENERATE(Mode::contact, Mode::sampled));
  const bool isGpu = GENERATE(false, true);
  bool failed = true;
  for (int failing = 0; failed; ++failing) {
    CAPTURE(isGpu, failing);
    const OwnMemory memory(isGpu);
    Sweeper(memory.device, teapots.scene, kOnDevice).run(std::span(teapots.queries).first(2), teapots.mode);
    OwnMemory::calls = 0;
    OwnMemory::failing = failing;
    Sweeper sweeper(memory.device, teapots.scene, kOnDevice);
    const Answers answers = sweeper.run(teapots.queries, teapots.mode);
    for (size_t i = 0; i < answers.results.size(); ++i) {
      if (!answers.reasons.contains(i)) {
        CHECK(test::sameBits(answers.results[i], teapots.answers[i]));
        continue;
      }
      CHECK(teapots.mode == Mode::sampled);
      CHECK(answers.results[i].status == Status::invalid);
      CHECK_THAT(answers.reasons.at(i), test::Contains("VK_ERROR_OUT_OF_DEVICE_MEMORY"));
    }
    CHECK(differenceOf(sweeper.run(teapots.queries, teapots.mode).results, teapots.answers) == "");
    failed = OwnMemory::calls > failing;
    CHECK((failed || failing > 0));
  }
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("a copy of a scene, recorders and sweepers say how much memory they hold, which is all that is held") {
  const Teapots teapots(20, Mode::contact);
  const OwnMemory memory(GENERATE(false, true));
  prepare(memory.device);
  OwnMemory::calls = 0;
  SceneCopy copy(memory.device, teapots.scene);
  std::vector<Recorder> recorders;
  recorders.emplace_back(copy);
  CHECK(copy.memoryUse() == 0);
  CHECK(recorders[0].memoryUse() == memory.device.memoryUse().used);
  recorders.emplace_back(memory.device, teapots.scene, Capacity{.queries = 500});
  gpu::Submission submission(memory.device.impl(), false);
  for (Recorder& recorder : recorders) {
    recorder.record(submission.begin(), teapots.queries);
    submission.submitAndWait();
  }
  CHECK(copy.memoryUse() > 0);
  CHECK(OwnMemory::calls <= 12);
  Sweeper sweeper(copy, kOnDevice);
  sweeper.run(teapots.queries);
  const uint64_t inContact = sweeper.memoryUse();
  sweeper.run(teapots.queries, Mode::sampled);
  CHECK(sweeper.memoryUse() > inContact);
  const uint64_t all = copy.memoryUse() + recorders[0].memoryUse() + recorders[1].memoryUse() + sweeper.memoryUse();
  CHECK(memory.device.memoryUse().used == all);
}

TEST_CASE("a host's allocator gives all memory, takes it back, and is told what it did wrong") {
  const HostDevice plain = test::device().handles();
  HostDevice host = plain;
  host.memory = test::separateAllocations(plain);
  const HostMemory given = host.memory;
  int pieces = 0;
  host.memory = {.allocate =
                     [&](const MemoryRequest& request, MemoryPiece& piece) {
                       ++pieces;
                       return given.allocate(request, piece);
                     },
                 .free =
                     [&](const MemoryPiece& piece) {
                       --pieces;
                       given.free(piece);
                     }};
  const Teapots teapots(20, Mode::sampled);
  {
    const Device device = Device::adopt(host);
    Sweeper sweeper(device, teapots.scene, kOnDevice);
    CHECK(differenceOf(sweeper.run(teapots.queries, teapots.mode).results, teapots.answers) == "");
    CHECK(pieces > 20);
    CHECK(device.memoryUse().allocations == static_cast<uint32_t>(pieces));
  }
  CHECK(pieces == 0);
  const auto wrongly = [&](const auto& change) {
    host.memory.allocate = [&](const MemoryRequest& request, MemoryPiece& piece) {
      const VkResult result = given.allocate(request, piece);
      change(piece);
      return result;
    };
    host.memory.free = given.free;
    CHECK_THROWS_WITH(Device::adopt(host), test::StartsWith("HostMemory::allocate (") && test::Contains("expected"));
  };
  wrongly([&](MemoryPiece& piece) {
    given.free(piece);
    piece.memory = VK_NULL_HANDLE;
  });
  wrongly([](MemoryPiece& piece) { piece.offset = 3; });
  wrongly([](MemoryPiece& piece) { piece.mapped = nullptr; });
  host.memory.free = nullptr;
  CHECK_THROWS_WITH(Device::adopt(host), "HostDevice::memory: expected both functions or none, got one");
}

TEST_CASE("a buffer takes little more memory than asked for, or half if it grows a little, in few steps") {
  const auto made = [] {
    return gpu::Buffer(test::device().impl(), "grown", gpu::BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  };
  for (VkDeviceSize bytes = 5000; bytes < 10'000'000; bytes += bytes / 7) {
    gpu::Buffer buffer = made();
    CHECK(buffer.reserve(bytes));
    REQUIRE(buffer.capacity() >= bytes);
    REQUIRE(buffer.capacity() <= bytes + bytes / 64 + 256);
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

// It would compile kernels anew for them.
TEST_CASE("no texel buffer has a size that lavapipe treats apart: a power of two, or a multiple of 64 KiB") {
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

TEST_CASE("reserve refuses more texels than the device allows, names both numbers and leaves the array as it was") {
  gpu::Array<std::array<uint32_t, 8>> nodes(test::device().impl(), "nodes", gpu::BufferDomain::device, gpu::kAsTexels);
  nodes.reserve(1);
  const VkBufferView view = nodes.view();
  const uint64_t most = std::min<uint64_t>(test::device().impl().properties.limits.maxTexelBufferElements, INT32_MAX);
  CHECK_THROWS_WITH(nodes.reserve(most / 2 + 1), "nodes: " + std::to_string(2 * (most / 2 + 1)) +
                                                     " texels, but the device's maxTexelBufferElements is " +
                                                     std::to_string(most));
  CHECK(nodes.view() == view);
}
