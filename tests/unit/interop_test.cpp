// Structs that C++ and GLSL share have the same layout: compares offsetof with the SPIR-V's decorations.
#include <algorithm>
#include <cstddef>
#include <fstream>
#include <map>
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
#include "spirv/host_query_comp_SCALAR.h"
#include "spirv/radar_shaders.h"
#include "spirv/shared_structs_comp.h"
#include "spirv/shared_structs_comp_RADAR_NO_DOUBLES.h"
#include "support/catch.h"

namespace {

using namespace radar::gpu;
using radar::shaders::kAll;

// struct -> member -> offset, and struct -> stride of its arrays.
struct Layouts {
  std::map<std::string, std::map<std::string, uint32_t>> offsets;
  std::map<std::string, uint32_t> strides;
};

Layouts layoutsOf(std::span<const uint32_t> spirv) {
  constexpr uint32_t kOpName = 5, kOpMemberName = 6, kOpTypeRuntimeArray = 29, kOpDecorate = 71, kOpMemberDecorate = 72;
  constexpr uint32_t kOffset = 35, kArrayStride = 6;
  std::map<uint32_t, std::string> names;
  std::map<std::pair<uint32_t, uint32_t>, std::string> memberNames;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> memberOffsets;
  std::map<uint32_t, uint32_t> arrayStrides, elementTypes;
  for (size_t at = 5; at < spirv.size(); at += spirv[at] >> 16) {
    const uint32_t op = spirv[at] & 0xffff;
    const auto text = [&](size_t from) { return std::string(reinterpret_cast<const char*>(&spirv[at + from])); };
    if (op == kOpName) names[spirv[at + 1]] = text(2);
    if (op == kOpMemberName) memberNames[{spirv[at + 1], spirv[at + 2]}] = text(3);
    if (op == kOpMemberDecorate && spirv[at + 3] == kOffset)
      memberOffsets[{spirv[at + 1], spirv[at + 2]}] = spirv[at + 4];
    if (op == kOpDecorate && spirv[at + 2] == kArrayStride) arrayStrides[spirv[at + 1]] = spirv[at + 3];
    if (op == kOpTypeRuntimeArray) elementTypes[spirv[at + 1]] = spirv[at + 2];
  }
  Layouts layouts;
  for (const auto& [member, offset] : memberOffsets) layouts.offsets[names[member.first]][memberNames[member]] = offset;
  for (const auto& [array, element] : elementTypes) layouts.strides[names[element]] = arrayStrides[array];
  return layouts;
}

bool hasDoubles(std::span<const uint32_t> spirv) {
  constexpr uint32_t kOpTypeFloat = 22;
  for (size_t at = 5; at < spirv.size(); at += spirv[at] >> 16) {
    if ((spirv[at] & 0xffff) == kOpTypeFloat && spirv[at + 2] == 64) return true;
  }
  return false;
}

struct Expected {
  std::string structure;
  size_t size;
  std::map<std::string, size_t> members;
};

#define MEMBER(type, name) \
  { #name, offsetof(type, name) }

const std::vector<Expected>& sharedStructs() {
  static const std::vector<Expected> all{
      {"MeshNode",
       sizeof(MeshNode),
       {MEMBER(MeshNode, centre), MEMBER(MeshNode, link), MEMBER(MeshNode, halfExtent), MEMBER(MeshNode, slabMiddle),
        MEMBER(MeshNode, normal), MEMBER(MeshNode, slabHalf)}},
      {"ObjectNode",
       sizeof(ObjectNode),
       {MEMBER(ObjectNode, centre), MEMBER(ObjectNode, link), MEMBER(ObjectNode, halfExtent), MEMBER(ObjectNode, pad)}},
      {"Vertex", sizeof(Vertex), {MEMBER(Vertex, position), MEMBER(Vertex, pad)}},
      {"Triangle", sizeof(Triangle), {MEMBER(Triangle, corners), MEMBER(Triangle, id)}},
      {"Placement",
       sizeof(Placement),
       {MEMBER(Placement, coarse), MEMBER(Placement, fine), MEMBER(Placement, inverse), MEMBER(Placement, reach),
        MEMBER(Placement, root), MEMBER(Placement, origin), MEMBER(Placement, perUnit), MEMBER(Placement, error),
        MEMBER(Placement, size), MEMBER(Placement, mask), MEMBER(Placement, mesh)}},
      {"MeshRecord",
       sizeof(MeshRecord),
       {MEMBER(MeshRecord, origin), MEMBER(MeshRecord, lo), MEMBER(MeshRecord, hi), MEMBER(MeshRecord, unit),
        MEMBER(MeshRecord, perUnit), MEMBER(MeshRecord, firstVertex), MEMBER(MeshRecord, firstTriangle),
        MEMBER(MeshRecord, firstNode)}},
      {"ObjectRecord",
       sizeof(ObjectRecord),
       {MEMBER(ObjectRecord, pose), MEMBER(ObjectRecord, mesh), MEMBER(ObjectRecord, pad)}},
      {"View",
       sizeof(View),
       {MEMBER(View, pose), MEMBER(View, direction), MEMBER(View, directionLength), MEMBER(View, distance),
        MEMBER(View, size), MEMBER(View, mesh), MEMBER(View, layer), MEMBER(View, resolution), MEMBER(View, width),
        MEMBER(View, height), MEMBER(View, cell), MEMBER(View, rangeScale), MEMBER(View, maskBase),
        MEMBER(View, maskScale), MEMBER(View, slack), MEMBER(View, rangeLimit), MEMBER(View, pad)}},
      {"Draw",
       sizeof(Draw),
       {MEMBER(Draw, clipFromMesh), MEMBER(Draw, origin), MEMBER(Draw, snap), MEMBER(Draw, slack), MEMBER(Draw, view),
        MEMBER(Draw, layer), MEMBER(Draw, mesh), MEMBER(Draw, object)}},
      {"Item", sizeof(Item), {MEMBER(Item, draw), MEMBER(Item, firstTriangle), MEMBER(Item, endTriangle)}},
      {"Candidate",
       sizeof(Candidate),
       {MEMBER(Candidate, pixel), MEMBER(Candidate, range), MEMBER(Candidate, mask), MEMBER(Candidate, itemB),
        MEMBER(Candidate, itemA)}},
      {"Answer",
       sizeof(Answer),
       {MEMBER(Answer, hi), MEMBER(Answer, object), MEMBER(Answer, triB), MEMBER(Answer, triA), MEMBER(Answer, feature),
        MEMBER(Answer, minL), MEMBER(Answer, flags), MEMBER(Answer, candidates), MEMBER(Answer, pairs),
        MEMBER(Answer, unresolvedPairs), MEMBER(Answer, pad)}},
      {"SampledUnresolved",
       sizeof(SampledUnresolved),
       {MEMBER(SampledUnresolved, low), MEMBER(SampledUnresolved, object), MEMBER(SampledUnresolved, triB),
        MEMBER(SampledUnresolved, triA), MEMBER(SampledUnresolved, pad)}},
      {"BoundsViolation",
       sizeof(BoundsViolation),
       {MEMBER(BoundsViolation, mesh), MEMBER(BoundsViolation, vertex), MEMBER(BoundsViolation, object)}},
      {"Gathered",
       sizeof(Gathered),
       {MEMBER(Gathered, query), MEMBER(Gathered, first), MEMBER(Gathered, count), MEMBER(Gathered, list),
        MEMBER(Gathered, listed)}},
      {"TransformLayout", sizeof(TransformLayout), {MEMBER(TransformLayout, row), MEMBER(TransformLayout, column)}},
      {"Moved",
       sizeof(Moved),
       {MEMBER(Moved, object), MEMBER(Moved, mesh), MEMBER(Moved, mask), MEMBER(Moved, firstByte),
        MEMBER(Moved, format), MEMBER(Moved, leaf), MEMBER(Moved, anchor), MEMBER(Moved, halfExtent)}},
      {"FloatTrial",
       sizeof(FloatTrial),
       {MEMBER(FloatTrial, x), MEMBER(FloatTrial, y), MEMBER(FloatTrial, z), MEMBER(FloatTrial, integer),
        MEMBER(FloatTrial, copied), MEMBER(FloatTrial, low), MEMBER(FloatTrial, bits)}},
      {"FloatOutcome",
       sizeof(FloatOutcome),
       {MEMBER(FloatOutcome, sum), MEMBER(FloatOutcome, product), MEMBER(FloatOutcome, quotient),
        MEMBER(FloatOutcome, chain), MEMBER(FloatOutcome, inverseRoot), MEMBER(FloatOutcome, ofInteger),
        MEMBER(FloatOutcome, copied), MEMBER(FloatOutcome, addedHigh), MEMBER(FloatOutcome, addedLow),
        MEMBER(FloatOutcome, apart), MEMBER(FloatOutcome, apartFirst), MEMBER(FloatOutcome, high),
        MEMBER(FloatOutcome, rest), MEMBER(FloatOutcome, centre), MEMBER(FloatOutcome, halfExtent),
        MEMBER(FloatOutcome, order)}},
      {"DoubleTrial",
       sizeof(DoubleTrial),
       {MEMBER(DoubleTrial, x), MEMBER(DoubleTrial, y), MEMBER(DoubleTrial, row), MEMBER(DoubleTrial, p),
        MEMBER(DoubleTrial, pad)}},
      {"DoubleOutcome",
       sizeof(DoubleOutcome),
       {MEMBER(DoubleOutcome, sum), MEMBER(DoubleOutcome, product), MEMBER(DoubleOutcome, quotient),
        MEMBER(DoubleOutcome, corrected), MEMBER(DoubleOutcome, placed), MEMBER(DoubleOutcome, ofFloat),
        MEMBER(DoubleOutcome, copied), MEMBER(DoubleOutcome, rests), MEMBER(DoubleOutcome, vectorRests),
        MEMBER(DoubleOutcome, chain), MEMBER(DoubleOutcome, ofDouble), MEMBER(DoubleOutcome, high),
        MEMBER(DoubleOutcome, low), MEMBER(DoubleOutcome, order)}},
      {"Sensor",
       sizeof(Sensor),
       {MEMBER(Sensor, placement), MEMBER(Sensor, frame), MEMBER(Sensor, direction), MEMBER(Sensor, scale),
        MEMBER(Sensor, centre), MEMBER(Sensor, distance), MEMBER(Sensor, halfExtent), MEMBER(Sensor, stopBefore),
        MEMBER(Sensor, mask), MEMBER(Sensor, firstExcluded), MEMBER(Sensor, endExcluded), MEMBER(Sensor, unscale)}},
      {"Sweep",
       sizeof(Sweep),
       {MEMBER(Sweep, pose), MEMBER(Sweep, direction), MEMBER(Sweep, directionLength), MEMBER(Sweep, distance),
        MEMBER(Sweep, anyHit), MEMBER(Sweep, result), MEMBER(Sweep, scale), MEMBER(Sweep, start),
        MEMBER(Sweep, ignoreLeaving), MEMBER(Sweep, isMirrored), MEMBER(Sweep, hasClearance),
        MEMBER(Sweep, stepPerUnit), MEMBER(Sweep, slack), MEMBER(Sweep, magnitude), MEMBER(Sweep, perParameter),
        MEMBER(Sweep, drift)}},
      {"SearchState",
       sizeof(SearchState),
       {MEMBER(SearchState, hi), MEMBER(SearchState, flags), MEMBER(SearchState, least)}},
      {"SearchTask",
       sizeof(SearchTask),
       {MEMBER(SearchTask, sensor), MEMBER(SearchTask, object), MEMBER(SearchTask, a), MEMBER(SearchTask, b),
        MEMBER(SearchTask, gap)}},
      {"CandidatePair",
       sizeof(CandidatePair),
       {MEMBER(CandidatePair, sensor), MEMBER(CandidatePair, object), MEMBER(CandidatePair, slotA),
        MEMBER(CandidatePair, slotB), MEMBER(CandidatePair, low)}},
      {"RefinedPair",
       sizeof(RefinedPair),
       {MEMBER(RefinedPair, low), MEMBER(RefinedPair, at), MEMBER(RefinedPair, error), MEMBER(RefinedPair, sensor),
        MEMBER(RefinedPair, object), MEMBER(RefinedPair, slotA), MEMBER(RefinedPair, slotB), MEMBER(RefinedPair, flags),
        MEMBER(RefinedPair, next), MEMBER(RefinedPair, first), MEMBER(RefinedPair, open)}},
      {"UnresolvedPair",
       sizeof(UnresolvedPair),
       {MEMBER(UnresolvedPair, sensor), MEMBER(UnresolvedPair, object), MEMBER(UnresolvedPair, triB),
        MEMBER(UnresolvedPair, triA), MEMBER(UnresolvedPair, mesh), MEMBER(UnresolvedPair, pad),
        MEMBER(UnresolvedPair, a), MEMBER(UnresolvedPair, b), MEMBER(UnresolvedPair, pose)}},
      {"SearchRound",
       sizeof(SearchRound),
       {MEMBER(SearchRound, tasks), MEMBER(SearchRound, taken), MEMBER(SearchRound, spilled)}},
      {"SearchCounts",
       sizeof(SearchCounts),
       {MEMBER(SearchCounts, filterGroups), MEMBER(SearchCounts, blockGroups), MEMBER(SearchCounts, candidates),
        MEMBER(SearchCounts, refinedPairs), MEMBER(SearchCounts, openPairs), MEMBER(SearchCounts, unresolved),
        MEMBER(SearchCounts, broken), MEMBER(SearchCounts, trianglePairs), MEMBER(SearchCounts, trianglePairsHigh),
        MEMBER(SearchCounts, queries), MEMBER(SearchCounts, rounds)}},
      {"SearchPush",
       sizeof(SearchPush),
       {MEMBER(SearchPush, round), MEMBER(SearchPush, taskCapacity), MEMBER(SearchPush, candidateCapacity),
        MEMBER(SearchPush, budget), MEMBER(SearchPush, width)}},
      {"CollectPush",
       sizeof(CollectPush),
       {MEMBER(CollectPush, round), MEMBER(CollectPush, taskCapacity), MEMBER(CollectPush, isLast)}},
      {"FilterPush", sizeof(FilterPush), {MEMBER(FilterPush, candidateCapacity)}},
      {"ResolvePush", sizeof(ResolvePush), {MEMBER(ResolvePush, sensors), MEMBER(ResolvePush, unresolvedCapacity)}},
      {"IdentifyPush", sizeof(IdentifyPush), {MEMBER(IdentifyPush, items)}},
      {"DeformPush",
       sizeof(DeformPush),
       {MEMBER(DeformPush, count), MEMBER(DeformPush, mesh), MEMBER(DeformPush, firstByte), MEMBER(DeformPush, stride),
        MEMBER(DeformPush, format), MEMBER(DeformPush, numbers), MEMBER(DeformPush, isBounded)}},
      {"Extent", sizeof(Extent), {MEMBER(Extent, lo), MEMBER(Extent, hi)}},
      {"DeformedSensor",
       sizeof(DeformedSensor),
       {MEMBER(DeformedSensor, sensor), MEMBER(DeformedSensor, mesh), MEMBER(DeformedSensor, slack),
        MEMBER(DeformedSensor, clearance), MEMBER(DeformedSensor, tolerance), MEMBER(DeformedSensor, exponent),
        MEMBER(DeformedSensor, way), MEMBER(DeformedSensor, certain), MEMBER(DeformedSensor, stopBefore),
        MEMBER(DeformedSensor, perWay)}},
      {"BoundPush",
       sizeof(BoundPush),
       {MEMBER(BoundPush, firstTriangle), MEMBER(BoundPush, count), MEMBER(BoundPush, extent)}},
      {"NormalisePush", sizeof(NormalisePush), {MEMBER(NormalisePush, count)}},
      {"PlacePush",
       sizeof(PlacePush),
       {MEMBER(PlacePush, count), MEMBER(PlacePush, anchor), MEMBER(PlacePush, anchorLow)}},
      {"RefitPush", sizeof(RefitPush), {MEMBER(RefitPush, first), MEMBER(RefitPush, count), MEMBER(RefitPush, mesh)}},
      {"FitPush", sizeof(FitPush), {MEMBER(FitPush, first), MEMBER(FitPush, count)}},
      {"MovePush", sizeof(MovePush), {MEMBER(MovePush, count), MEMBER(MovePush, anchor), MEMBER(MovePush, anchorLow)}},
      {"ReachPush", sizeof(ReachPush), {MEMBER(ReachPush, count)}},
      {"PlanPush",
       sizeof(PlanPush),
       {MEMBER(PlanPush, queries), MEMBER(PlanPush, stride), MEMBER(PlanPush, countByte), MEMBER(PlanPush, meshes),
        MEMBER(PlanPush, start), MEMBER(PlanPush, inRange), MEMBER(PlanPush, anchor), MEMBER(PlanPush, anchorLow)}},
      {"InvalidatePush", sizeof(InvalidatePush), {MEMBER(InvalidatePush, count)}},
      {"GatherPush", sizeof(GatherPush), {MEMBER(GatherPush, count), MEMBER(GatherPush, first)}},
  };
  return all;
}

// Of a shared struct, or of the other type that slots have.
std::string strideOf(const std::string& type) {
  for (const Expected& one : sharedStructs()) {
    if (one.structure == type) return std::to_string(one.size);
  }
  return type == "uint" ? "4" : "";
}

// Of the bindings by number: the shared struct of a buffer's elements, or their stride; "" of an image.
std::map<uint32_t, std::string> elementsOf(std::span<const uint32_t> spirv) {
  constexpr uint32_t kOpName = 5, kOpTypeRuntimeArray = 29, kOpTypeStruct = 30, kOpTypePointer = 32, kOpVariable = 59,
                     kOpDecorate = 71, kArrayStride = 6, kBinding = 33, kDescriptorSet = 34, kStorageBuffer = 12;
  std::map<uint32_t, std::string> names, elements;
  std::map<uint32_t, uint32_t> numbers, strides, inner;  // of a pointer, an array, or a struct's last member
  for (size_t at = 5; at < spirv.size(); at += spirv[at] >> 16) {
    const uint32_t op = spirv[at] & 0xffff, last = spirv[at + (spirv[at] >> 16) - 1];
    if (op == kOpName) names[spirv[at + 1]] = reinterpret_cast<const char*>(&spirv[at + 2]);
    if (op == kOpDecorate && spirv[at + 2] == kBinding) numbers[spirv[at + 1]] = last;
    if (op == kOpDecorate && spirv[at + 2] == kArrayStride) strides[spirv[at + 1]] = last;
    if (op == kOpDecorate && spirv[at + 2] == kDescriptorSet) CHECK(last == 0);
    if (op == kOpTypePointer || op == kOpTypeRuntimeArray || op == kOpTypeStruct) inner[spirv[at + 1]] = last;
    if (op != kOpVariable || numbers.count(spirv[at + 2]) == 0) continue;
    std::string& element = elements[numbers.at(spirv[at + 2])];
    if (spirv[at + 3] != kStorageBuffer) continue;
    const uint32_t member = inner.at(inner.at(spirv[at + 1]));
    const std::string& name = names[strides.count(member) == 1 ? inner.at(member) : member];
    const bool isShared = name == "RadarResult" || !strideOf(name).empty();
    element = isShared ? name : std::to_string(strides.at(member));
  }
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

// radar/result.glsl declares it for hosts.
const Expected& publicResult() {
  using radar::Result;
  static const Expected result{
      "RadarResult",
      sizeof(Result),
      {MEMBER(Result, status), MEMBER(Result, tier), MEMBER(Result, detected), MEMBER(Result, resolution),
       MEMBER(Result, t), MEMBER(Result, lo), MEMBER(Result, hi), MEMBER(Result, fraction), MEMBER(Result, object),
       MEMBER(Result, triB), MEMBER(Result, triA), MEMBER(Result, flags), MEMBER(Result, featureB),
       MEMBER(Result, featureA), MEMBER(Result, point), MEMBER(Result, normal), MEMBER(Result, paperMinL)}};
  return result;
}

// Checks a struct that the module has. The module has no stride for it if it has no array of it.
void checkLayout(const Layouts& layouts, const Expected& one) {
  const auto& found = layouts.offsets.at(one.structure);
  CHECK(found.size() == one.members.size());
  for (const auto& [member, offset] : one.members) {
    CAPTURE(member);
    REQUIRE(found.count(member) == 1);
    CHECK(found.at(member) == offset);
  }
  if (layouts.strides.count(one.structure) == 1) CHECK(layouts.strides.at(one.structure) == one.size);
}

std::set<std::string> structsIn(const char* header) {
  std::ifstream stream(std::string(RADAR_SHADERS) + "/" + header);
  REQUIRE(stream);
  const std::regex definition("^struct (\\w+) \\{");
  std::set<std::string> names;
  std::smatch match;
  for (std::string line; std::getline(stream, line);) {
    if (std::regex_search(line, match, definition)) names.insert(match[1]);
  }
  return names;
}

}  // namespace

TEST_CASE("every shared struct has the offsets and the stride that the shaders use") {
  const bool doubles = GENERATE(true, false);
  const Layouts layouts =
      layoutsOf(doubles ? std::span<const uint32_t>(k_shared_structs_comp) : k_shared_structs_comp_RADAR_NO_DOUBLES);
  for (const Expected& one : sharedStructs()) {
    CAPTURE(doubles, one.structure);
    // Only shaders with doubles have these structs.
    if (!doubles && (one.structure == "DoubleTrial" || one.structure == "DoubleOutcome")) continue;
    REQUIRE(layouts.strides.count(one.structure) == 1);
    checkLayout(layouts, one);
  }
}

TEST_CASE("no shared struct is left out of the comparison") {
  std::set<std::string> declared, compared;
  for (const char* folder : {"arithmetic", "contact", "embed", "sampled", "shared"}) {
    declared.merge(structsIn((std::string(folder) + "/interop.h").c_str()));
  }
  for (const Expected& one : sharedStructs()) compared.insert(one.structure);
  CHECK(declared.size() > 20);
  CHECK(declared == compared);
}

TEST_CASE("the engine's shaders lay out shared structs and results as C++ does") {
  std::set<std::string> seen;
  for (const Shader* shader : kAll) {
    for (const std::span<const uint32_t> spirv : {shader->spirv, shader->spirvWithoutDoubles}) {
      const Layouts layouts = layoutsOf(spirv);
      const auto check = [&](const Expected& one) {
        if (layouts.offsets.count(one.structure) == 0) return;
        CAPTURE(shader->name, one.structure);
        seen.insert(one.structure);
        checkLayout(layouts, one);
      };
      for (const Expected& one : sharedStructs()) check(one);
      check(publicResult());
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
  slots["embed"].merge(slotsIn("contact/interop.h"));
  // Arguments are told apart by their numbers alone.
  for (auto at = slots["embed"].begin(), next = std::next(at); next != slots["embed"].end(); at = next++) {
    CAPTURE(at->second, next->second);
    CHECK(at->first != next->first);
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
          return slot.second == (element == "RadarResult" ? "Result" : element) || strideOf(slot.second) == element;
        }));
      }
    }
  }
}

TEST_CASE("a host's query has one layout in C++ and in shaders, std430 or scalar") {
  using radar::HostQuery;
  const Expected query{
      "RadarQuery",
      sizeof(HostQuery),
      {MEMBER(HostQuery, worldFromMesh), MEMBER(HostQuery, direction), MEMBER(HostQuery, distance),
       MEMBER(HostQuery, mesh), MEMBER(HostQuery, mask), MEMBER(HostQuery, exclude), MEMBER(HostQuery, flags)}};
  for (const std::span<const uint32_t> spirv :
       {std::span<const uint32_t>(k_host_query_comp), std::span<const uint32_t>(k_host_query_comp_SCALAR)}) {
    const Layouts layouts = layoutsOf(spirv);
    REQUIRE(layouts.strides.count("RadarQuery") == 1);
    checkLayout(layouts, query);
  }
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
  const std::set<std::string> onlyWithDoubles{"arithmetic/doubles", "contact/block", "contact/refine"};
  for (const Shader* shader : kAll) {
    CAPTURE(shader->name);
    const bool hasVariant = !shader->spirvWithoutDoubles.empty();
    CHECK(hasDoubles(shader->spirv) == (hasVariant || onlyWithDoubles.count(shader->name) == 1));
    if (hasVariant) CHECK_FALSE(hasDoubles(shader->spirvWithoutDoubles));
  }
}
