// A wrong argument does not compile, or throws an error that names the kernel and the binding.
#include "gpu/kernel_fixture.h"
#include "spirv/refused_comp_BINDS_NOTHING.h"
#include "spirv/refused_comp_PUSHES_132_BYTES.h"
#include "support/catch.h"

namespace {

using namespace radar;
using namespace radar::test;
using gpu::Argument;
using gpu::Array;
using gpu::BufferDomain;
using gpu::Commands;
using gpu::KernelArguments;
using gpu::Slot;
using gpu::TexelArray;

static_assert(std::is_constructible_v<Argument, Slot<Node>, const Array<Node>&>);
static_assert(std::is_constructible_v<Argument, Slot<Node>, const TexelArray<Node>&>);
static_assert(!std::is_constructible_v<Argument, Slot<Node>, const Array<uint32_t>&>);
static_assert(!std::is_constructible_v<Argument, Slot<Node>, const TexelArray<Groups>&>);
static_assert(!std::is_constructible_v<Argument, Slot<Node>, const gpu::Buffer&>);
static_assert(!std::is_constructible_v<Argument, Slot<Node>, VkImageView, VkSampler>);
static_assert(!std::is_constructible_v<Argument, uint32_t, const Array<Node>&>);

// Slots with the numbers of others, but not with the shader's types.
constexpr Slot<Node> kValuesAsNodes{kSlotValues.number};
constexpr Slot<uint32_t> kGroupsAsNumber{kSlotGroups.number};
constexpr Slot<gpu::SampledImage> kValuesAsImage{kSlotValues.number};

template <class T>
Array<T> one(const char* name) {
  Array<T> array(impl(), name, BufferDomain::device);
  array.reserve(1);
  return array;
}

struct Buffers {
  Array<uint32_t> values = numbers("values", 10), results = numbers("results", 10);
  Array<Node> nodes = one<Node>("nodes");
  Array<Groups> groups = one<Groups>("groups");
};

std::string messageOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

std::string messageOf(const gpu::Kernel& kernel, std::initializer_list<Argument> arguments) {
  return messageOf([&] { KernelArguments(kernel).set(arguments); });
}

}  // namespace

TEST_CASE("setting wrong arguments throws an error that names the kernel and the binding") {
  const Buffers b;
  const gpu::Kernel& scale = kernels().scale;
  CHECK(messageOf(scale, {{kSlotValues, b.values}}) == "kernel \"scale\", binding 7 (Results) is missing");
  CHECK(messageOf(scale, {{kSlotValues, b.values}, {kSlotResults, b.results}, {kSlotNodes, b.nodes}}) ==
        "kernel \"scale\" has no binding 3");
  CHECK(messageOf(scale, {{kSlotValues, b.values}, {kSlotResults, b.results}, {kSlotValues, b.values}}) ==
        "kernel \"scale\", binding 0 (Values) is given twice");
  CHECK(messageOf(scale, {{kValuesAsNodes, b.nodes}, {kSlotResults, b.results}}) ==
        "kernel \"scale\", binding 0 (Values) has elements of 4 bytes, but \"nodes\" has elements of 32");
  CHECK(messageOf(scale, {{kValuesAsImage, VK_NULL_HANDLE, VK_NULL_HANDLE}, {kSlotResults, b.results}}) ==
        "kernel \"scale\", binding 0 (Values) is not an image");
  CHECK(messageOf(kernels().countGroups, {{kGroupsAsNumber, b.values}}) ==
        "kernel \"count groups\", binding 2 (Command) is a struct of 12 bytes, but \"values\" has elements of 4");
  CHECK(messageOf(kernels().sumTexels, {{kSlotNodes, b.nodes}, {kSlotResults, b.results}}) ==
        "kernel \"sum texels\", binding 3 (nodes) reads texels, but \"nodes\" is not a TexelArray");
  const Slot<Node> depthAsNodes{kSlotDepth.number};
  CHECK(messageOf(kernels().readDepth, {{depthAsNodes, b.nodes}, {kSlotResults, b.results}}) ==
        "kernel \"read depth\", binding 5 (depth) is an image, not a buffer");
}

TEST_CASE("refused arguments leave the previous ones in place") {
  const uint32_t count = 10;
  Buffers b;
  KernelArguments arguments(kernels().scale);
  arguments.set({{kSlotValues, b.values}, {kSlotResults, b.results}});
  const Array<uint32_t> other = numbers("other", count);
  CHECK_THROWS_AS(arguments.set({{kSlotResults, other}}), Error);
  run([&](const Commands& commands) { arguments.dispatch(commands, 1, ScalePush{count, 9}); });
  CHECK(b.results.mapped()[9] == 81);
  CHECK(other.mapped()[9] == 9);
}

TEST_CASE("a dispatch is refused before the arguments are set and with push constants of the wrong size") {
  const Buffers b;
  KernelArguments scale(kernels().scale), countGroups(kernels().countGroups);
  const Commands none;
  CHECK(messageOf([&] { scale.dispatch(none, 1, ScalePush{}); }) ==
        "kernel \"scale\" is used before its arguments were set");
  scale.set({{kSlotValues, b.values}, {kSlotResults, b.results}});
  countGroups.set({{kSlotGroups, b.groups}});
  CHECK(messageOf([&] { scale.dispatch(none, 1); }) ==
        "kernel \"scale\" has push constants of 8 bytes, but was given 0");
  CHECK(messageOf([&] { scale.dispatch(none, 1, 1u); }) ==
        "kernel \"scale\" has push constants of 8 bytes, but was given 4");
  CHECK(messageOf([&] { countGroups.dispatch(none, 0, ScalePush{}); }) ==
        "kernel \"count groups\" has push constants of 4 bytes, but was given 8");
  CHECK(messageOf([&] { scale.dispatchIndirect(none, b.groups, 0); }) ==
        "kernel \"scale\" has push constants of 8 bytes, but was given 0");
}

TEST_CASE("a shader without descriptors or with more push constants than every device supports is refused") {
  CHECK(messageOf([] { const gpu::Kernel kernel(impl(), k_refused_comp_BINDS_NOTHING, "idle"); }) ==
        "kernel \"idle\" has no descriptors");
  CHECK(messageOf([] { const gpu::Kernel kernel(impl(), k_refused_comp_PUSHES_132_BYTES, "long"); }) ==
        "kernel \"long\" has push constants of 132 bytes, but only 128 are portable");
}
