// Dispatches apply their arguments and push constants for any number of workgroups and buffers.
#include "gpu/kernel_fixture.h"
#include "support/catch.h"

namespace {

using namespace radar;
using namespace radar::test;
using gpu::Array;
using gpu::BufferDomain;
using gpu::Commands;
using gpu::Passes;

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
  Passes passes(impl(), {kScaleOf64});
  for (const uint32_t count : {0u, 1u, 63u, 64u, 65u, 1234u}) {
    CAPTURE(count);
    const Array<uint32_t> values = numbers("values", count), results = untouched(count);
    passes.begin();
    run([&](const Commands& commands) {
      passes(commands, kScaleOf64, gpu::groupsFor(count, 64), ScalePush{count, 3},
             {{kSlotValues, values}, {kSlotResults, results}});
    });
    CHECK(firstWrong(results, count, 3, 0) == count);
  }
}

TEST_CASE("more workgroups than one axis allows are laid out in rows") {
  Passes passes(impl());
  for (const uint32_t count : {65535u, 65536u, 65537u, 200001u}) {
    CAPTURE(count);
    const Array<uint32_t> values = numbers("values", count), results = untouched(count);
    run([&](const Commands& commands) {
      passes(commands, kScaleAndAdd5, count, ScalePush{count, 2}, {{kSlotResults, results}, {kSlotValues, values}});
    });
    CHECK(firstWrong(results, count, 2, 5) == count);
  }
}

TEST_CASE("an indirect dispatch runs as many workgroups as an earlier kernel wrote, and the count can be overwritten") {
  Array<Groups> command(impl(), "command", BufferDomain::device, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
  command.reserve(1);
  Passes passes(impl());
  const uint32_t most = 70000;
  const Array<uint32_t> values = numbers("values", most), results = untouched(most);
  run([&](const Commands& commands) {
    // The factor shows which dispatch wrote last: 0 workgroups write nothing, then 70,000 write all, then 10 rewrite
    // the first 10.
    for (const auto& [groups, factor] : {std::pair{0u, 1u}, {most, 2u}, {10u, 3u}}) {
      passes(commands, kCountGroups, 1, groups, {{kSlotGroups, command}});
      gpu::computeWriteToIndirect(commands);
      passes(commands, kScaleAndAdd5, {command, 0}, ScalePush{most, factor},
             {{kSlotValues, values}, {kSlotResults, results}});
      gpu::computeWriteToComputeReadWrite(commands);
    }
  });
  for (uint32_t i = 0; i < most; ++i) {
    if (results.mapped()[i] != (i < 10 ? 3 : 2) * i + 5) FAIL("at " << i);
  }
  CHECK(results.mapped()[most] == kUntouched);
}

TEST_CASE("dispatches of one program in one recording do not see each other's arguments") {
  const uint32_t count = 100;
  const Array<uint32_t> values = numbers("values", count);
  const Array<uint32_t> results[] = {untouched(count), untouched(count)};
  Passes passes(impl(), {kScaleOf64});
  run([&](const Commands& commands) {
    for (int i = 0; i < 2; ++i) {
      passes(commands, kScaleOf64, 2, ScalePush{count, i == 0 ? 7u : 11u},
             {{kSlotValues, values}, {kSlotResults, results[i]}});
    }
  });
  CHECK(firstWrong(results[0], count, 7, 0) == count);
  CHECK(firstWrong(results[1], count, 11, 0) == count);
}

TEST_CASE("a kernel samples a depth image") {
  const gpu::RenderPass pass = gpu::depthRenderPass(impl());
  const gpu::Sampler sampler = gpu::texelSampler(impl());
  gpu::DepthArray depth(impl(), "depth", pass.get(), 4, 2);
  const Array<uint32_t> results = untouched(2);
  Passes passes(impl());
  run([&](const Commands& commands) {
    depth.recordFirstUse(commands);
    depth.beginPass(commands, 0, 2, 4);  // clears to 1
    commands->CmdEndRenderPass(commands);
    passes(commands, kReadDepth, 2, {{kSlotDepth, depth, sampler.get()}, {kSlotResults, results}});
  });
  CHECK(results.mapped()[0] == 1000);
  CHECK(results.mapped()[1] == 1000);
}

namespace {

PFN_vkUpdateDescriptorSets updateDescriptorSets;
PFN_vkAllocateDescriptorSets allocateDescriptorSets;
uint32_t updates, sets;

VKAPI_ATTR void VKAPI_CALL countUpdates(VkDevice device, uint32_t writes, const VkWriteDescriptorSet* write,
                                        uint32_t copies, const VkCopyDescriptorSet* copy) {
  updates += writes;
  updateDescriptorSets(device, writes, write, copies, copy);
}

VKAPI_ATTR VkResult VKAPI_CALL countSets(VkDevice device, const VkDescriptorSetAllocateInfo* info,
                                         VkDescriptorSet* made) {
  sets += info->descriptorSetCount;
  return allocateDescriptorSets(device, info, made);
}

// What `f` makes and writes.
struct Work {
  uint32_t sets, descriptors;
  bool operator==(const Work&) const = default;
};
template <class F>
Work workOf(F&& f) {
  gpu::Api& vk = device().impl().vk;
  updates = sets = 0;
  updateDescriptorSets = std::exchange(vk.UpdateDescriptorSets, countUpdates);
  allocateDescriptorSets = std::exchange(vk.AllocateDescriptorSets, countSets);
  f();
  vk.UpdateDescriptorSets = updateDescriptorSets;
  vk.AllocateDescriptorSets = allocateDescriptorSets;
  return {sets, updates};
}

}  // namespace

TEST_CASE("sets are kept, found by their buffers, and given others only once no earlier recording is pending") {
  Passes passes(impl());
  CHECK(workOf([&] { passes.reserve({kScaleOf64}); }) == Work{1, 0});
  CHECK(workOf([&] { passes.reserve({kScaleOf64}); }) == Work{0, 0});
  Array<uint32_t> values = numbers("values", 10);
  const Array<uint32_t> results = untouched(10), others = untouched(10);
  const auto record = [&](const Array<uint32_t>& to) {
    return workOf([&] {
      run([&](const Commands& commands) {
        passes(commands, kScaleOf64, 1, ScalePush{10, 2}, {{kSlotValues, values}, {kSlotResults, to}});
      });
    });
  };
  CHECK(record(results) == Work{0, 2});
  CHECK(record(results) == Work{0, 0});
  CHECK(record(others) == Work{1, 2});
  CHECK(record(results) == Work{0, 0});
  passes.begin();
  CHECK(record(others) == Work{0, 0});
  REQUIRE(values.reserve(100000));
  CHECK(record(others) == Work{0, 2});   // of the set that this recording does not use
  CHECK(record(results) == Work{1, 2});  // both are in use
  REQUIRE_FALSE(values.reserve(10));
  CHECK(record(others) == Work{0, 0});
  // A buffer that replaces another may have the same handle.
  for (int i = 0; i < 8; ++i) {
    values = Array<uint32_t>(impl(), "none", BufferDomain::device);
    values = Array<uint32_t>(impl(), "values", BufferDomain::device);
    values.reserve(10);
    passes.begin();
    const Work work = record(others);
    CHECK(work.sets == 0);
    CHECK(work.descriptors > 0);
  }
}
