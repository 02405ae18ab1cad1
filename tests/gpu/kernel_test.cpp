// Kernels apply their arguments and push constants for any number of workgroups and users.
#include "gpu/depth_array.h"
#include "gpu/kernel_fixture.h"
#include "support/catch.h"

namespace {

using namespace radar;
using namespace radar::test;
using gpu::Array;
using gpu::BufferDomain;
using gpu::Commands;
using gpu::KernelArguments;

constexpr uint32_t kUntouched = 0xdeadbeef;

// One element more than `count`, which shows a write beyond the end.
Array<uint32_t> untouched(uint32_t count) {
  Array<uint32_t> array(impl(), "results", BufferDomain::readback);
  array.reserve(count + 1);
  std::fill_n(array.mapped(), count + 1, kUntouched);
  return array;
}

// Expects results[i] = factor * i + offset for i < count and nothing beyond. Returns the first wrong index, or else
// `count`.
uint32_t firstWrong(const Array<uint32_t>& results, uint32_t count, uint32_t factor, uint32_t offset) {
  for (uint32_t i = 0; i < count; ++i) {
    if (results.mapped()[i] != factor * i + offset) return i;
  }
  return results.mapped()[count] == kUntouched ? count : count + 1;
}

}  // namespace

TEST_CASE("a kernel writes every element and none beyond, for sizes around that of a workgroup") {
  KernelArguments arguments(kernels().scale);
  for (const uint32_t count : {0u, 1u, 63u, 64u, 65u, 1234u}) {
    CAPTURE(count);
    const Array<uint32_t> values = numbers("values", count), results = untouched(count);
    arguments.set({{kSlotValues, values}, {kSlotResults, results}});
    run([&](const Commands& commands) {
      arguments.dispatch(commands, gpu::groupsFor(count, 64), ScalePush{count, 3});
    });
    CHECK(firstWrong(results, count, 3, 0) == count);
  }
}

TEST_CASE("more workgroups than one axis allows are laid out in rows") {
  KernelArguments arguments(kernels().scaleAndAdd5);
  for (const uint32_t count : {65535u, 65536u, 65537u, 200001u}) {
    CAPTURE(count);
    const Array<uint32_t> values = numbers("values", count), results = untouched(count);
    arguments.set({{kSlotResults, results}, {kSlotValues, values}});
    run([&](const Commands& commands) { arguments.dispatch(commands, count, ScalePush{count, 2}); });
    CHECK(firstWrong(results, count, 2, 5) == count);
  }
}

TEST_CASE("an indirect dispatch runs as many workgroups as an earlier kernel wrote, and the count can be overwritten") {
  Array<Groups> command(impl(), "command", BufferDomain::device, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
  command.reserve(1);
  KernelArguments count(kernels().countGroups), scale(kernels().scaleAndAdd5);
  const uint32_t most = 70000;
  const Array<uint32_t> values = numbers("values", most), results = untouched(most);
  count.set({{kSlotGroups, command}});
  scale.set({{kSlotValues, values}, {kSlotResults, results}});
  run([&](const Commands& commands) {
    // The factor shows which dispatch wrote last: 0 workgroups write nothing, then 70,000 write all, then 10 rewrite
    // the first 10.
    for (const auto& [groups, factor] : {std::pair{0u, 1u}, {most, 2u}, {10u, 3u}}) {
      count.dispatch(commands, 1, groups);
      gpu::computeWriteToIndirect(commands);
      scale.dispatchIndirect(commands, command, 0, ScalePush{most, factor});
      gpu::computeWriteToComputeReadWrite(commands);
    }
  });
  for (uint32_t i = 0; i < most; ++i) {
    if (results.mapped()[i] != (i < 10 ? 3 : 2) * i + 5) FAIL("at " << i);
  }
  CHECK(results.mapped()[most] == kUntouched);
}

TEST_CASE("an indirect dispatch without its barrier is reported as a hazard") {
  Array<Groups> command(impl(), "command", BufferDomain::device, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
  command.reserve(1);
  KernelArguments count(kernels().countGroups), scale(kernels().scale);
  const Array<uint32_t> values = numbers("values", 1), results = untouched(1);
  count.set({{kSlotGroups, command}});
  scale.set({{kSlotValues, values}, {kSlotResults, results}});
  {
    gpu::Submission submission(impl(), false);  // recorded but never submitted
    const Commands commands = submission.begin();
    count.dispatch(commands, 1, 1u);
    scale.dispatchIndirect(commands, command, 0, ScalePush{1, 1});
  }
  const std::vector<std::string> messages = takeValidationMessages();
  REQUIRE_FALSE(messages.empty());
  CHECK_THAT(messages[0], test::Contains("SYNC-HAZARD-READ-AFTER-WRITE"));
}

TEST_CASE("two users of one kernel do not see each other's arguments") {
  const uint32_t count = 100;
  const Array<uint32_t> values = numbers("values", count);
  const Array<uint32_t> results[] = {untouched(count), untouched(count)};
  KernelArguments users[] = {KernelArguments(kernels().scale), KernelArguments(kernels().scale)};
  for (int i = 0; i < 2; ++i) users[i].set({{kSlotValues, values}, {kSlotResults, results[i]}});
  run([&](const Commands& commands) {
    for (int i = 0; i < 2; ++i) users[i].dispatch(commands, 2, ScalePush{count, i == 0 ? 7u : 11u});
  });
  CHECK(firstWrong(results[0], count, 7, 0) == count);
  CHECK(firstWrong(results[1], count, 11, 0) == count);
}

TEST_CASE("a kernel samples a depth image") {
  const gpu::RenderPass pass = gpu::depthRenderPass(impl());
  const gpu::Sampler sampler = gpu::texelSampler(impl());
  gpu::DepthArray depth(impl(), "depth", pass.get(), 4, 2);
  const Array<uint32_t> results = untouched(2);
  KernelArguments arguments(kernels().readDepth);
  arguments.set({{kSlotDepth, depth.view(), sampler.get()}, {kSlotResults, results}});
  run([&](const Commands& commands) {
    depth.recordFirstUse(commands);
    depth.beginPass(commands, 0, 2, 4);  // clears to 1
    commands->CmdEndRenderPass(commands);
    arguments.dispatch(commands, 2);
  });
  CHECK(results.mapped()[0] == 1000);
  CHECK(results.mapped()[1] == 1000);
}

namespace {

PFN_vkUpdateDescriptorSets updateDescriptorSets;
uint32_t updates;

VKAPI_ATTR void VKAPI_CALL countUpdates(VkDevice device, uint32_t writes, const VkWriteDescriptorSet* write,
                                        uint32_t copies, const VkCopyDescriptorSet* copy) {
  updates += writes;
  updateDescriptorSets(device, writes, write, copies, copy);
}

// The number of descriptors that `f` writes.
template <class F>
uint32_t updatesOf(F&& f) {
  gpu::Api& vk = device().impl().vk;
  updates = 0;
  updateDescriptorSets = std::exchange(vk.UpdateDescriptorSets, countUpdates);
  f();
  vk.UpdateDescriptorSets = updateDescriptorSets;
  return updates;
}

}  // namespace

TEST_CASE("setting arguments writes only the descriptors whose buffers have changed") {
  KernelArguments arguments(kernels().scale);
  Array<uint32_t> values = numbers("values", 10);
  const Array<uint32_t> results = untouched(10);
  const auto set = [&] { arguments.set({{kSlotValues, values}, {kSlotResults, results}}); };
  CHECK(updatesOf(set) == 2);
  CHECK(updatesOf(set) == 0);
  REQUIRE(values.reserve(100000));
  CHECK(updatesOf(set) == 1);
  REQUIRE_FALSE(values.reserve(10));
  CHECK(updatesOf(set) == 0);
  // A buffer that replaces another may have the same handle.
  for (int i = 0; i < 8; ++i) {
    values = Array<uint32_t>(impl(), "none", BufferDomain::device);
    values = Array<uint32_t>(impl(), "values", BufferDomain::device);
    values.reserve(10);
    CHECK(updatesOf(set) == 1);
  }
}
