// Structs that C++ and GLSL share have the same layout: compares offsetof with the SPIR-V's decorations.
#include <algorithm>
#include <cstddef>
#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <span>
#include <string>

#include "radar/host.h"
#include "radar/radar.h"
#include "shaders/arithmetic/interop.h"
#include "shaders/contact/interop.h"
#include "shaders/embed/interop.h"
#include "shaders/sampled/interop.h"
#include "spirv/host_query_comp.h"
#include "spirv/radar_shaders.h"
#include "spirv/shared_structs_comp.h"
#include "spirv/shared_structs_comp_RADAR_NO_DOUBLES.h"
#include "support/catch.h"

namespace {

using namespace radar::gpu;
using radar::shaders::kAll;

// Calls read(op, words) for each instruction; word 0 is the first operand.
template <class Read>
void forEachInstruction(std::span<const uint32_t> spirv, const Read& read) {
  for (size_t at = 5, length = 0; at < spirv.size(); at += length) {
    length = spirv[at] >> 16;
    read(spirv[at] & 0xffff, spirv.subspan(at + 1, length - 1));
  }
}

std::string textOf(std::span<const uint32_t> words) {
  return reinterpret_cast<const char*>(words.data());
}

constexpr uint32_t kOpName = 5, kOpMemberName = 6, kOpTypeRuntimeArray = 29, kOpTypeStruct = 30, kOpTypePointer = 32,
                   kOpVariable = 59, kOpDecorate = 71, kOpMemberDecorate = 72;
constexpr uint32_t kArrayStride = 6, kBinding = 33, kDescriptorSet = 34, kOffset = 35;  // decorations
constexpr uint32_t kStorageBuffer = 12;

// A struct's members and their offsets, and the stride of its arrays.
struct Layout {
  std::map<std::string, size_t> members;
  std::optional<size_t> stride;
};

// By the names of structs.
std::map<std::string, Layout> layoutsOf(std::span<const uint32_t> spirv) {
  std::map<uint32_t, std::string> names;
  std::map<std::pair<uint32_t, uint32_t>, std::string> memberNames;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> memberOffsets;
  std::map<uint32_t, uint32_t> arrayStrides, elementTypes;
  forEachInstruction(spirv, [&](uint32_t op, std::span<const uint32_t> words) {
    if (op == kOpName) names[words[0]] = textOf(words.subspan(1));
    if (op == kOpMemberName) memberNames[{words[0], words[1]}] = textOf(words.subspan(2));
    if (op == kOpMemberDecorate && words[2] == kOffset) memberOffsets[{words[0], words[1]}] = words[3];
    if (op == kOpDecorate && words[1] == kArrayStride) arrayStrides[words[0]] = words[2];
    if (op == kOpTypeRuntimeArray) elementTypes[words[0]] = words[1];
  });
  std::map<std::string, Layout> layouts;
  for (const auto& [member, offset] : memberOffsets) layouts[names[member.first]].members[memberNames[member]] = offset;
  for (const auto& [array, element] : elementTypes) layouts[names[element]].stride = arrayStrides[array];
  return layouts;
}

using RadarResult = radar::Result;
using RadarQuery = radar::HostQuery;

// Of every shared struct, as C++ has it.
const std::map<std::string, Layout>& sharedStructs() {
  static const std::map<std::string, Layout> all = [] {
    std::map<std::string, Layout> structs;
#define STRUCT(type, number) structs[#type].stride = sizeof(type);
#define MEMBER(type, name) structs[#type].members[#name] = offsetof(type, name);
#include "shared_structs.h"
    return structs;
  }();
  return all;
}

// Of a shared struct, or of the other type that slots have.
std::string strideOf(const std::string& type) {
  const auto found = sharedStructs().find(type == "Result" ? "RadarResult" : type);
  return found != sharedStructs().end() ? std::to_string(*found->second.stride) : type == "uint" ? "4" : "";
}

// Of the bindings by number: the shared struct of a buffer's elements, or their stride; "" of an image.
std::map<uint32_t, std::string> elementsOf(std::span<const uint32_t> spirv) {
  std::map<uint32_t, std::string> names, elements;
  std::map<uint32_t, uint32_t> numbers, strides, inner;  // of a pointer, an array, or a struct's last member
  forEachInstruction(spirv, [&](uint32_t op, std::span<const uint32_t> words) {
    const uint32_t last = words.empty() ? 0 : words.back();
    if (op == kOpName) names[words[0]] = textOf(words.subspan(1));
    if (op == kOpDecorate && words[1] == kBinding) numbers[words[0]] = last;
    if (op == kOpDecorate && words[1] == kArrayStride) strides[words[0]] = last;
    if (op == kOpDecorate && words[1] == kDescriptorSet) CHECK(last == 0);
    if (op == kOpTypePointer || op == kOpTypeRuntimeArray || op == kOpTypeStruct) inner[words[0]] = last;
    if (op != kOpVariable || numbers.count(words[1]) == 0) return;
    std::string& element = elements[numbers.at(words[1])];
    if (words[2] != kStorageBuffer) return;
    const uint32_t member = inner.at(inner.at(words[0]));
    const std::string& name = names[strides.count(member) == 1 ? inner.at(member) : member];
    element = strideOf(name).empty() ? std::to_string(strides.at(member)) : name;
  });
  return elements;
}

// The types of a header's slots, by number.
std::multimap<uint32_t, std::string> slotsIn(const char* header) {
  std::ifstream stream(std::string(RADAR_SHADERS) + "/" + header);
  REQUIRE(stream);
  const std::regex slot("^INTEROP_SLOT\\(\\w+, (\\d+), (\\w+)\\)");
  std::multimap<uint32_t, std::string> slots;
  std::smatch match;
  for (std::string line; std::getline(stream, line);) {
    if (std::regex_search(line, match, slot)) slots.emplace(std::stoul(match[1]), match[2]);
  }
  return slots;
}

// The module has no stride for a struct of which it has no array.
void checkLayout(const Layout& found, const Layout& expected) {
  CHECK(found.members.size() == expected.members.size());
  for (const auto& [member, offset] : expected.members) {
    CAPTURE(member);
    REQUIRE(found.members.count(member) == 1);
    CHECK(found.members.at(member) == offset);
  }
  if (found.stride) CHECK(*found.stride == *expected.stride);
}

}  // namespace

TEST_CASE("every shared struct has the offsets and the stride that the shaders use") {
  const bool doubles = GENERATE(true, false);
  const std::map<std::string, Layout> layouts =
      layoutsOf(doubles ? std::span<const uint32_t>(k_shared_structs_comp) : k_shared_structs_comp_RADAR_NO_DOUBLES);
  CHECK(sharedStructs().size() >= 45);
  for (const auto& [name, expected] : sharedStructs()) {
    CAPTURE(doubles, name);
    REQUIRE(layouts.count(name) == 1);
    CHECK(layouts.at(name).stride);
    checkLayout(layouts.at(name), expected);
  }
}

TEST_CASE("the engine's shaders lay out shared structs and results as C++ does") {
  std::set<std::string> seen;
  for (const Shader* shader : kAll) {
    for (const std::span<const uint32_t> spirv : {shader->spirv, shader->spirvWithoutDoubles}) {
      for (const auto& [name, layout] : layoutsOf(spirv)) {
        if (layout.members.empty() || sharedStructs().count(name) == 0) continue;
        CAPTURE(shader->name, name);
        seen.insert(name);
        checkLayout(layout, sharedStructs().at(name));
      }
    }
  }
  for (const char* name :
       {"RadarResult", "SearchCounts", "SearchPush", "RefinedPair", "Placement", "MeshNode", "View"}) {
    CAPTURE(name);
    CHECK(seen.count(name) == 1);
  }
}

TEST_CASE("the build describes what each shader binds, and buffers have the elements of their slots") {
  std::map<std::string, std::multimap<uint32_t, std::string>> slots;
  for (const char* folder : {"arithmetic", "contact", "embed", "sampled"}) {
    slots[folder] = slotsIn((std::string(folder) + "/interop.h").c_str());
    slots[folder].merge(slotsIn("shared/interop.h"));
  }
  // Arguments are told apart by their numbers alone.
  for (const char* folder : {"embed", "sampled"}) {
    std::multimap<uint32_t, std::string>& all = slots[folder];
    all.merge(slotsIn("contact/interop.h"));
    for (auto at = all.begin(), next = std::next(at); next != all.end(); at = next++) {
      CAPTURE(at->second, next->second);
      CHECK(at->first != next->first);
    }
  }
  for (const Shader* shader : kAll) {
    const std::string name = shader->name;
    const auto& ofFolder = slots.at(name.substr(0, name.find('/')));
    for (const std::span<const uint32_t> spirv : {shader->spirv, shader->spirvWithoutDoubles}) {
      const std::map<uint32_t, std::string> elements = elementsOf(spirv);
      CHECK((spirv.empty() || elements.size() == shader->bindings.size()));
      for (const Binding& binding : shader->bindings) {
        CAPTURE(name, binding.number, binding.name);
        if (spirv.empty()) continue;
        REQUIRE(elements.count(binding.number) == 1);
        const std::string& element = elements.at(binding.number);
        CHECK(element.empty() == (binding.type != VK_DESCRIPTOR_TYPE_STORAGE_BUFFER));
        if (element.empty()) continue;
        const auto [first, end] = ofFolder.equal_range(binding.number);
        CHECK(std::any_of(first, end, [&](const auto& slot) {
          const std::string& type = slot.second;
          return (type == "Result" ? "RadarResult" : type) == element || strideOf(type) == element;
        }));
      }
    }
  }
}

TEST_CASE("a host's query has in std430 the layout that it has in C++ and in scalar layout") {
  const Layout query = layoutsOf(k_host_query_comp).at("RadarQuery");
  CHECK(query.stride);
  checkLayout(query, sharedStructs().at("RadarQuery"));
}

TEST_CASE("structs that shaders read as texels have as many whole texels as the shaders assume") {
  constexpr size_t kTexel = 4 * sizeof(float);
  CHECK(sizeof(Placement) == kPlacementTexels * kTexel);
  CHECK(sizeof(Sensor) == kSensorTexels * kTexel);
  CHECK(offsetof(Sensor, placement) == 0);
  CHECK(sizeof(MeshNode) == 3 * kTexel);
  CHECK(sizeof(ObjectNode) == 2 * kTexel);
  CHECK(sizeof(Vertex) == kTexel);
  CHECK(sizeof(Triangle) == kTexel);
}

TEST_CASE("every shader that uses doubles has a variant without them or is used only on devices with doubles") {
  const std::set<std::string> onlyWithDoubles{"arithmetic/doubles", "contact/block", "contact/certify",
                                              "contact/describe",   "contact/prove", "contact/refine",
                                              "contact/separate"};
  for (const Shader* shader : kAll) {
    CAPTURE(shader->name);
    const bool hasVariant = !shader->spirvWithoutDoubles.empty();
    CHECK(radar::gpu::hasDoubles(shader->spirv) == (hasVariant || onlyWithDoubles.count(shader->name) == 1));
    if (hasVariant) CHECK_FALSE(radar::gpu::hasDoubles(shader->spirvWithoutDoubles));
  }
}
