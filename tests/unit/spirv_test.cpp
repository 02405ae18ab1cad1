// The descriptors and push constants of a shader are read from its SPIR-V.
#include <vector>

#include "gpu/spirv.h"
#include "radar/radar.h"
#include "shaders/arithmetic/interop.h"
#include "shaders/contact/interop.h"
#include "shaders/sampled/interop.h"
#include "spirv/all_kinds_comp.h"
#include "spirv/all_kinds_comp_DESCRIPTOR_ARRAY.h"
#include "spirv/all_kinds_comp_OTHER_SET.h"
#include "spirv/all_kinds_comp_SAME_BINDING.h"
#include "spirv/all_kinds_comp_STORAGE_IMAGE.h"
#include "spirv/all_kinds_comp_UNIFORM_BUFFER.h"
#include "spirv/arithmetic_doubles_comp.h"
#include "spirv/contact_collect_comp.h"
#include "spirv/contact_resolve_comp.h"
#include "spirv/contact_search_comp.h"
#include "spirv/sampled_depth_vert.h"
#include "spirv/sampled_reduce_comp.h"
#include "support/catch.h"

namespace {

using namespace radar;
using namespace radar::gpu;

constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                           kTexels = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,
                           kImage = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;

bool equal(const Descriptor& a, const Descriptor& b) {
  return a.binding == b.binding && a.name == b.name && a.type == b.type && a.stride == b.stride &&
         a.arrayOffset == b.arrayOffset && a.bytes == b.bytes;
}

void checkDescriptors(std::span<const uint32_t> spirv, const std::vector<Descriptor>& expected) {
  const std::vector<Descriptor> found = reflectShader(spirv, "found").descriptors;
  REQUIRE(found.size() == expected.size());
  for (size_t i = 0; i < found.size(); ++i) {
    CAPTURE(i, found[i].binding, found[i].name, found[i].type, found[i].stride, found[i].arrayOffset, found[i].bytes);
    CHECK(equal(found[i], expected[i]));
  }
}

const Descriptor& descriptorAt(const ShaderInterface& found, uint32_t binding) {
  for (const Descriptor& descriptor : found.descriptors) {
    if (descriptor.binding == binding) return descriptor;
  }
  throw std::runtime_error("no binding " + std::to_string(binding));
}

// A copy of the SPIR-V: in the first instruction `op` whose word `keyWord` is `key`, word `word` is `value`.
std::vector<uint32_t> changed(std::span<const uint32_t> spirv, uint32_t op, size_t keyWord, uint32_t key, size_t word,
                              uint32_t value) {
  std::vector<uint32_t> copy(spirv.begin(), spirv.end());
  for (size_t at = 5; at < copy.size(); at += copy[at] >> 16) {
    if ((copy[at] & 0xffff) != op || copy[at + keyWord] != key) continue;
    copy[at + word] = value;
    return copy;
  }
  throw std::runtime_error("no instruction " + std::to_string(op));
}

}  // namespace

TEST_CASE("every kind of descriptor is found, in the order of bindings") {
  checkDescriptors(k_all_kinds_comp, {{1, "positions", kTexels},
                                      {2, "counted", kStorage, 12, 16, 0},
                                      {3, "Plain", kStorage, 0, 0, 32},
                                      {4, "Words", kStorage, 4, 0, 0},
                                      {5, "depth", kImage},
                                      {9, "texels", kTexels}});
}

TEST_CASE("the size of push constants equals that of the same struct in C++") {
  struct Pair {
    float weight;
    double value;
  };
  struct Push {
    uint32_t window[2];
    Pair pairs[2];
    float scale[3];
  };
  CHECK(reflectShader(k_all_kinds_comp, "all kinds").pushBytes == sizeof(Push));
  CHECK(sizeof(Push) == 56);
  CHECK(reflectShader(k_contact_search_comp, "search").pushBytes == sizeof(SearchPush));
  CHECK(reflectShader(k_arithmetic_doubles_comp, "double arithmetic").pushBytes == 0);
}

TEST_CASE("the descriptors of the engine's shaders match the shared structs") {
  checkDescriptors(k_arithmetic_doubles_comp,
                   {{kSlotDoubleTrials.number, "Trials", kStorage, sizeof(DoubleTrial)},
                    {kSlotDoubleOutcomes.number, "Outcomes", kStorage, sizeof(DoubleOutcome)}});
  checkDescriptors(k_contact_collect_comp, {{kSlotStates.number, "States", kStorage, sizeof(SearchState)},
                                            {kSlotCounts.number, "Counts", kStorage, 0, 0, sizeof(SearchCounts)},
                                            {kSlotTasks.number, "Tasks", kStorage, sizeof(SearchTask)},
                                            {kSlotSpilled.number, "Spilled", kStorage, sizeof(SearchTask)}});
  const ShaderInterface search = reflectShader(k_contact_search_comp, "search");
  CHECK(descriptorAt(search, kSlotMeshNodes.number).type == kTexels);
  CHECK(descriptorAt(search, kSlotCandidatePairs.number).stride == sizeof(CandidatePair));
  const ShaderInterface resolve = reflectShader(k_contact_resolve_comp, "resolve");
  CHECK(descriptorAt(resolve, kSlotUnresolved.number).stride == sizeof(UnresolvedPair));
  CHECK(descriptorAt(resolve, kSlotResults.number).stride == sizeof(Result));
  const ShaderInterface reduce = reflectShader(k_sampled_reduce_comp, "reduce");
  CHECK(descriptorAt(reduce, kSlotRange.number).type == kImage);
  CHECK(descriptorAt(reduce, kSlotMask.number).type == kImage);
}

TEST_CASE("a texel buffer is also recognised in SPIR-V before 1.6, where it is a sampled image") {
  // The image with a sampler becomes one whose dimension is Buffer (5, from 2D: 1).
  const std::vector<uint32_t> older = changed(k_all_kinds_comp, 25, 3, 1, 3, 5);
  CHECK(descriptorAt(reflectShader(older, "older"), 5).type == kTexels);
}

TEST_CASE("the message about an unsupported descriptor names it") {
  const auto reflect = [](std::span<const uint32_t> spirv) { reflectShader(spirv, "x"); };
  CHECK_THROWS_WITH(reflect(k_all_kinds_comp_UNIFORM_BUFFER),
                    "shader \"x\": binding 6 (Refused) is a uniform buffer, or a storage buffer of SPIR-V before 1.3");
  CHECK_THROWS_WITH(
      reflect(k_all_kinds_comp_STORAGE_IMAGE),
      "shader \"x\": binding 6 (refused) is not a storage buffer, a uniform texel buffer or an image with "
      "its sampler");
  CHECK_THROWS_WITH(reflect(k_all_kinds_comp_DESCRIPTOR_ARRAY),
                    "shader \"x\": binding 6 (refused) is an array of descriptors");
  CHECK_THROWS_WITH(reflect(k_all_kinds_comp_OTHER_SET),
                    "shader \"x\": binding 6 (Refused) is in descriptor set 1, not 0");
  CHECK_THROWS_WITH(reflect(k_all_kinds_comp_SAME_BINDING),
                    "shader \"x\": binding 4 is declared twice: Words and Refused");
  CHECK_THROWS_WITH(reflect(k_sampled_depth_vert),
                    "shader \"x\": expected one entry point, a compute shader's \"main\"");
}

TEST_CASE("words that are not SPIR-V are refused, and a truncated module is not read beyond its end") {
  const auto reflect = [](std::span<const uint32_t> spirv) { reflectShader(spirv, "x"); };
  const std::span<const uint32_t> whole = k_all_kinds_comp;
  CHECK_THROWS_WITH(reflect({}), "shader \"x\": not SPIR-V");
  CHECK_THROWS_WITH(reflect(whole.subspan(1)), "shader \"x\": not SPIR-V");
  // A separate copy, so that a sanitizer sees a read beyond its end.
  for (size_t words = 0; words < whole.size(); ++words) {
    const std::vector<uint32_t> part(whole.begin(), whole.begin() + static_cast<ptrdiff_t>(words));
    try {
      reflect(part);
    } catch (const Error&) {
      continue;
    }
  }
  CHECK_NOTHROW(reflect(whole));
}
