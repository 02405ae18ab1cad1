// Arrays that shaders read as texels hold what was uploaded or written as storage, also after they have grown.
#include <algorithm>
#include <numeric>

#include "gpu/kernel_fixture.h"
#include "support/catch.h"

namespace {

using namespace radar;
using namespace radar::test;
using gpu::Array;
using gpu::BufferDomain;
using gpu::Commands;
using gpu::Passes;

Array<Node> makeNodes() {
  return {impl(), "nodes", BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_DST_BIT | gpu::kAsTexels};
}

// The sum of a node's words, which count up from `first`.
uint32_t sumFrom(uint32_t first) {
  return 8 * first + 28;
}

bool sumsAre(const Array<uint32_t>& sums, uint32_t count, uint32_t first) {
  for (uint32_t i = 0; i < count; ++i) {
    if (sums.mapped()[i] != sumFrom(first + 8 * i)) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("texels have the uploaded values, also after the array has grown") {
  Array<Node> nodes = makeNodes();
  Passes passes(impl());
  gpu::Upload upload(impl());
  for (const uint32_t count : {1u, 63u, 64u, 65u, 1234u}) {
    CAPTURE(count);
    std::vector<Node> uploaded(count);
    std::iota(uploaded[0].word, uploaded[0].word + 8 * count, 1000u);
    nodes.reserve(count);
    CHECK(nodes.capacity() >= count);
    const Array<uint32_t> sums = numbers("sums", count);
    upload.begin();
    upload.add(uploaded.data(), gpu::bytesOf(uploaded), nodes);
    run([&](const Commands& commands) {
      upload.record(commands);
      gpu::uploadToRead(commands);
      passes(commands, kSumTexels, count, {{kSlotNodes, nodes}, {kSlotResults, sums}});
    });
    CHECK(sumsAre(sums, count, 1000));
  }
}

TEST_CASE("texels have the values that a kernel wrote as storage") {
  constexpr uint32_t kCount = 100;
  Array<Node> nodes = makeNodes();
  nodes.reserve(kCount);
  Passes passes(impl());
  const Array<uint32_t> sums = numbers("sums", kCount);
  const auto fill = [&](const Commands& commands, uint32_t first) {
    passes(commands, kFillNodes, kCount, first, {{kSlotNodes, nodes}});
  };
  const auto sum = [&](const Commands& commands) {
    passes(commands, kSumTexels, kCount, {{kSlotNodes, nodes}, {kSlotResults, sums}});
  };
  run([&](const Commands& commands) {
    for (const uint32_t first : {5u, 17u}) {
      fill(commands, first);
      gpu::computeWriteToComputeReadWrite(commands);
      sum(commands);
      gpu::computeWriteToComputeReadWrite(commands);
    }
  });
  CHECK(sumsAre(sums, kCount, 17));
  CHECK(takeValidationMessages().empty());
}

TEST_CASE("reserve refuses more texels than the device allows, names both numbers and leaves the array as it was") {
  Array<Node> nodes = makeNodes();
  nodes.reserve(1);
  const VkBufferView view = nodes.view();
  const uint64_t most = std::min<uint64_t>(impl().properties.limits.maxTexelBufferElements, INT32_MAX);
  CHECK_THROWS_WITH(nodes.reserve(most / 2 + 1), "nodes: " + std::to_string(2 * (most / 2 + 1)) +
                                                     " texels, but the device's maxTexelBufferElements is " +
                                                     std::to_string(most));
  CHECK(nodes.view() == view);
}
