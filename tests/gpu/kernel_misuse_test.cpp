// A wrong argument does not compile, or throws an error that names the shader and the binding.
#include "gpu/kernel_fixture.h"
#include "support/catch.h"

namespace {

using namespace radar;
using namespace radar::test;
using gpu::Argument;
using gpu::Array;
using gpu::BufferDomain;
using gpu::Commands;
using gpu::Passes;
using gpu::Slot;

static_assert(std::is_constructible_v<Argument, Slot<Node>, const Array<Node>&>);
static_assert(!std::is_constructible_v<Argument, Slot<Node>, const Array<uint32_t>&>);
static_assert(!std::is_constructible_v<Argument, Slot<Node>, const gpu::Buffer&>);
static_assert(!std::is_constructible_v<Argument, Slot<Node>, const gpu::DepthArray&, VkSampler>);
static_assert(!std::is_constructible_v<Argument, uint32_t, const Array<Node>&>);

// A slot with the number of another, but not with the shader's type.
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

constexpr Commands kNowhere;

// Of a dispatch of kScale, which is refused before anything is recorded.
std::string messageOf(std::initializer_list<Argument> arguments) {
  return messageOf([&] { Passes{impl()}(kNowhere, kScaleOf64, 1, ScalePush{}, arguments); });
}

}  // namespace

TEST_CASE("wrong arguments are refused with an error that names the shader and the binding") {
  const Buffers b;
  CHECK(messageOf({{kSlotValues, b.values}}) == "shader \"gpu/scale\", binding 7 (Results) is missing");
  const std::string other = "shader \"gpu/scale\" binds something else, or is given something twice";
  CHECK(messageOf({{kSlotValues, b.values}, {kSlotResults, b.results}, {kSlotNodes, b.nodes}}) == other);
  CHECK(messageOf({{kSlotValues, b.values}, {kSlotResults, b.results}, {kSlotValues, b.values}}) == other);
  const gpu::RenderPass pass = gpu::depthRenderPass(impl());
  const gpu::DepthArray depth(impl(), "depth", pass.get(), 4, 1);
  CHECK(messageOf({{kValuesAsImage, depth, VK_NULL_HANDLE}, {kSlotResults, b.results}}) ==
        "shader \"gpu/scale\", binding 0 (Values) is not an image");
  Passes run(impl());
  CHECK(messageOf([&] {
          run(kNowhere, kSumTexels, 1, {{kSlotNodes, b.nodes}, {kSlotResults, b.results}});
        }) == "shader \"gpu/sum_texels\", binding 3 (nodes) reads texels, but \"nodes\" has none");
  const Slot<Node> depthAsNodes{kSlotDepth.number};
  CHECK(messageOf([&] {
          run(kNowhere, kReadDepth, 1, {{depthAsNodes, b.nodes}, {kSlotResults, b.results}});
        }) == "shader \"gpu/read_depth\", binding 5 (depth) is an image, not a buffer");
}

TEST_CASE("push constants of the wrong size are refused, also if nothing is dispatched") {
  const Buffers b;
  Passes run(impl());
  const std::initializer_list<Argument> ofScale{{kSlotValues, b.values}, {kSlotResults, b.results}};
  CHECK(messageOf([&] { run(kNowhere, kScaleOf64, 1, ofScale); }) ==
        "shader \"gpu/scale\" has push constants of 8 bytes, but was given 0");
  CHECK(messageOf([&] { run(kNowhere, kScaleOf64, 1, 1u, ofScale); }) ==
        "shader \"gpu/scale\" has push constants of 8 bytes, but was given 4");
  CHECK(messageOf([&] {
          run(kNowhere, kCountGroups, 0, ScalePush{}, {{kSlotGroups, b.groups}});
        }) == "shader \"gpu/count_groups\" has push constants of 4 bytes, but was given 8");
  CHECK(messageOf([&] {
          run(kNowhere, kScaleOf64, {b.groups, 0}, ofScale);
        }) == "shader \"gpu/scale\" has push constants of 8 bytes, but was given 0");
}
