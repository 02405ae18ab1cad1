// Pieces of an upload arrive where they should, from as many blocks of memory as they need, and blocks are kept.
#include <algorithm>
#include <memory>

#include "gpu/kernel_fixture.h"
#include "support/catch.h"
#include "workloads/random.h"

namespace {

using namespace radar;
using test::impl;

/// Counts the buffers that are made.
class CountedBuffers {
 public:
  CountedBuffers() : device_(test::device().impl()) {
    createBuffer = device_.vk.CreateBuffer;
    calls = 0;
    device_.vk.CreateBuffer = [](VkDevice device, const VkBufferCreateInfo* info,
                                 const VkAllocationCallbacks* allocator, VkBuffer* buffer) {
      ++calls;
      return createBuffer(device, info, allocator, buffer);
    };
  }
  ~CountedBuffers() { device_.vk.CreateBuffer = createBuffer; }
  CountedBuffers(const CountedBuffers&) = delete;
  CountedBuffers& operator=(const CountedBuffers&) = delete;

  inline static int calls;

 private:
  inline static PFN_vkCreateBuffer createBuffer;
  Device::Impl& device_;
};

/// Zeros that the host can read.
gpu::Array<uint32_t> targetOf(uint32_t words) {
  gpu::Array<uint32_t> target(impl(), "target", gpu::BufferDomain::upload, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  target.reserve(words);
  std::fill_n(target.mapped(), words, 0u);
  return target;
}

struct Piece {
  size_t target;
  uint32_t first, count;  ///< words
};

/// Pieces of targets of `words` words, apart from one another, partly in their order.
std::vector<Piece> randomPieces(size_t targets, uint32_t words, tools::Random& random) {
  std::vector<Piece> pieces;
  for (uint32_t at = 0; at < words;) {
    const uint32_t count = std::min(random.below(random.oneIn(8) ? 3000 : 40), words - at);
    pieces.push_back(
        {pieces.empty() || random.oneIn(3) ? random.below(uint32_t(targets)) : pieces.back().target, at, count});
    at += count + (random.oneIn(2) ? random.below(50) : 0);
  }
  for (Piece& piece : pieces) {
    if (random.oneIn(3)) std::swap(piece, pieces[random.below(uint32_t(pieces.size()))]);
  }
  return pieces;
}

}  // namespace

TEST_CASE("pieces over several blocks arrive where they should, and the kept blocks suffice for them again") {
  constexpr size_t kTargets = 3;
  constexpr uint32_t kWords = 20'000;
  tools::Random random(1);
  std::vector<gpu::Array<uint32_t>> targets;
  for (size_t i = 0; i < kTargets; ++i) targets.push_back(targetOf(kWords));
  std::vector<std::vector<uint32_t>> expected(kTargets, std::vector<uint32_t>(kWords));
  const std::vector<Piece> pieces = randomPieces(kTargets, kWords, random);
  gpu::Upload upload(impl());
  for (uint32_t round = 0; round < 3; ++round) {
    CAPTURE(round);
    const CountedBuffers made;
    VkDeviceSize bytes = 0;
    upload.begin();
    CHECK(upload.bytes() == 0);
    for (const auto& [target, first, count] : pieces) {
      uint32_t* const words = &expected[target][first];
      for (uint32_t i = 0; i < count; ++i) words[i] = random.below(1u << 31);
      upload.add(words, 4 * count, targets[target], 4 * first);
      bytes += 4 * count;
    }
    CHECK(upload.bytes() == bytes);
    if (round == 0) CHECK(CountedBuffers::calls > 3);
    if (round == 0) CHECK(CountedBuffers::calls < 15);
    if (round != 0) CHECK(CountedBuffers::calls == 0);
    test::run([&](const gpu::Commands& commands) { upload.record(commands); });
    for (size_t i = 0; i < kTargets; ++i) {
      CHECK(std::equal(expected[i].begin(), expected[i].end(), targets[i].mapped()));
    }
  }
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("reserved pieces need no more memory, and lie one behind the other") {
  tools::Random random(2);
  const gpu::Array<uint32_t> target = targetOf(50'000);
  gpu::Upload upload(impl());
  for (uint32_t round = 0; round < 40; ++round) {
    CAPTURE(round);
    if (round % 8 == 0) upload.begin();
    std::vector<VkDeviceSize> sizes(1 + random.below(20));
    VkDeviceSize all = 0;
    for (VkDeviceSize& size : sizes) all += gpu::roundedUp(size = 1 + random.below(500), 8);
    upload.reserve(all);
    const CountedBuffers made;
    const std::byte* end = nullptr;
    for (const VkDeviceSize size : sizes) {
      const std::byte* at = upload.place(size, target, random.below(1000));
      CHECK((end == nullptr || at == end));
      end = at + gpu::roundedUp(size, 8);
    }
    CHECK(CountedBuffers::calls == 0);
  }
}

TEST_CASE("all pieces together may exceed the device's largest buffer, but none alone") {
  constexpr uint32_t kWords = 5000;
  const gpu::Array<uint32_t> target = targetOf(2 * kWords);
  std::vector<uint32_t> words(2 * kWords);
  for (uint32_t i = 0; i < words.size(); ++i) words[i] = i;
  Device::Impl& device = test::device().impl();
  const std::shared_ptr<void> restore(nullptr,
                                      [&, most = device.maxBufferBytes](void*) { device.maxBufferBytes = most; });
  device.maxBufferBytes = 4 * kWords;
  gpu::Upload upload(impl());
  for (uint32_t at = 0; at < words.size(); at += 1000) upload.add(&words[at], 4000, target, 4 * at);
  CHECK_THROWS_WITH(upload.reserve(4 * kWords + 4), test::StartsWith("staging: 20004 bytes"));
  test::run([&](const gpu::Commands& commands) { upload.record(commands); });
  CHECK(std::equal(words.begin(), words.end(), target.mapped()));
}
