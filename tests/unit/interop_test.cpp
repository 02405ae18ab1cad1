// The structs that C++ and GLSL share have the same layout: offsetof against the SPIR-V's own decorations.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <map>
#include <set>
#include <span>
#include <string>

#include "radar/radar.h"
#include "shaders/interop.h"
#include "spirv/bounds_comp.h"
#include "spirv/contact_comp.h"
#include "spirv/contact_comp_RADAR_NO_DOUBLES.h"
#include "spirv/deform_comp.h"
#include "spirv/depth_vert.h"
#include "spirv/identify_comp.h"
#include "spirv/mask_comp.h"
#include "spirv/move_comp.h"
#include "spirv/move_comp_RADAR_NO_DOUBLES.h"
#include "spirv/outer_draw_comp.h"
#include "spirv/outer_fill_comp.h"
#include "spirv/outer_identify_comp.h"
#include "spirv/outer_reduce_comp.h"
#include "spirv/pairs_comp.h"
#include "spirv/reduce_comp.h"
#include "spirv/refit_comp.h"
#include "spirv/refuse_comp.h"
#include "spirv/solve_comp.h"
#include "spirv/solve_comp_RADAR_NO_DOUBLES.h"
#include "spirv/tell_comp.h"
#include "spirv/tell_comp_RADAR_NO_DOUBLES.h"

namespace {

using namespace radar::gpu;

// struct -> member -> offset, and struct -> stride of the arrays of it.
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
  for (const auto& [array, stride] : arrayStrides) layouts.strides[names[elementTypes[array]]] = stride;
  return layouts;
}

// Every shader that is compiled.
const std::pair<const char*, std::span<const uint32_t>> kShaders[] = {
    {"depth.vert", k_depth_vert},
    {"reduce.comp", k_reduce_comp},
    {"identify.comp", k_identify_comp},
    {"solve.comp", k_solve_comp},
    {"solve.comp without doubles", k_solve_comp_RADAR_NO_DOUBLES},
    {"bounds.comp", k_bounds_comp},
    {"pairs.comp", k_pairs_comp},
    {"contact.comp", k_contact_comp},
    {"mask.comp", k_mask_comp},
    {"outer_draw.comp", k_outer_draw_comp},
    {"outer_fill.comp", k_outer_fill_comp},
    {"outer_reduce.comp", k_outer_reduce_comp},
    {"outer_identify.comp", k_outer_identify_comp},
    {"contact.comp without doubles", k_contact_comp_RADAR_NO_DOUBLES},
    {"tell.comp", k_tell_comp},
    {"tell.comp without doubles", k_tell_comp_RADAR_NO_DOUBLES},
    {"deform.comp", k_deform_comp},
    {"refit.comp", k_refit_comp},
    {"move.comp", k_move_comp},
    {"move.comp without doubles", k_move_comp_RADAR_NO_DOUBLES},
    {"refuse.comp", k_refuse_comp},
};

struct Expected {
  const char* structure;
  size_t size;
  std::map<std::string, size_t> members;
};

#define MEMBER(type, name) \
  { #name, offsetof(type, name) }

}  // namespace

TEST_CASE("every shared struct has the offsets and the stride that the shaders use") {
  const Expected expected[] = {
      {"MeshRecord",
       sizeof(MeshRecord),
       {MEMBER(MeshRecord, centre), MEMBER(MeshRecord, halfExtent), MEMBER(MeshRecord, firstVertex),
        MEMBER(MeshRecord, firstIndex), MEMBER(MeshRecord, firstNode)}},
      {"ObjectRecord",
       sizeof(ObjectRecord),
       {MEMBER(ObjectRecord, pose), MEMBER(ObjectRecord, mesh), MEMBER(ObjectRecord, pad)}},
      {"View",
       sizeof(View),
       {MEMBER(View, pose), MEMBER(View, direction), MEMBER(View, directionLength), MEMBER(View, distance),
        MEMBER(View, size), MEMBER(View, mesh), MEMBER(View, layer), MEMBER(View, resolution), MEMBER(View, width),
        MEMBER(View, height), MEMBER(View, cell), MEMBER(View, rangeScale), MEMBER(View, maskBase),
        MEMBER(View, maskScale), MEMBER(View, slack), MEMBER(View, rangeLimit), MEMBER(View, firstPixel)}},
      {"Draw",
       sizeof(Draw),
       {MEMBER(Draw, clipFromMesh), MEMBER(Draw, snap), MEMBER(Draw, slack), MEMBER(Draw, view), MEMBER(Draw, layer),
        MEMBER(Draw, mesh), MEMBER(Draw, object)}},
      {"Band",
       sizeof(Band),
       {MEMBER(Band, pixelsFromMesh), MEMBER(Band, snap), MEMBER(Band, slack), MEMBER(Band, view),
        MEMBER(Band, firstPixel), MEMBER(Band, pitch), MEMBER(Band, firstVertex), MEMBER(Band, firstIndex),
        MEMBER(Band, triangles), MEMBER(Band, firstColumn), MEMBER(Band, endColumn), MEMBER(Band, firstRow),
        MEMBER(Band, endRow), MEMBER(Band, fromRow), MEMBER(Band, toRow), MEMBER(Band, item), MEMBER(Band, isSensor)}},
      {"Strip",
       sizeof(Strip),
       {MEMBER(Strip, firstRow), MEMBER(Strip, endRow), MEMBER(Strip, firstBand), MEMBER(Strip, endBand)}},
      {"Item", sizeof(Item), {MEMBER(Item, draw), MEMBER(Item, firstTriangle), MEMBER(Item, endTriangle)}},
      {"Candidate",
       sizeof(Candidate),
       {MEMBER(Candidate, pixel), MEMBER(Candidate, range), MEMBER(Candidate, mask), MEMBER(Candidate, itemB),
        MEMBER(Candidate, itemA)}},
      {"Answer",
       sizeof(Answer),
       {MEMBER(Answer, hi), MEMBER(Answer, object), MEMBER(Answer, triB), MEMBER(Answer, triA), MEMBER(Answer, feature),
        MEMBER(Answer, minL), MEMBER(Answer, flags), MEMBER(Answer, candidates), MEMBER(Answer, pairs),
        MEMBER(Answer, openPairs), MEMBER(Answer, lo)}},
      {"OpenPair",
       sizeof(OpenPair),
       {MEMBER(OpenPair, low), MEMBER(OpenPair, object), MEMBER(OpenPair, triB), MEMBER(OpenPair, triA),
        MEMBER(OpenPair, pad)}},
      {"ClusterRecord",
       sizeof(ClusterRecord),
       {MEMBER(ClusterRecord, centre), MEMBER(ClusterRecord, halfExtent), MEMBER(ClusterRecord, edge),
        MEMBER(ClusterRecord, first), MEMBER(ClusterRecord, count)}},
      {"Target",
       sizeof(Target),
       {MEMBER(Target, pose), MEMBER(Target, direction), MEMBER(Target, directionLength), MEMBER(Target, distance),
        MEMBER(Target, mesh), MEMBER(Target, firstPair), MEMBER(Target, pairCapacity), MEMBER(Target, firstContender),
        MEMBER(Target, contenderCapacity), MEMBER(Target, enough), MEMBER(Target, corner),
        MEMBER(Target, pixelsPerUnit), MEMBER(Target, maskCost), MEMBER(Target, decides), MEMBER(Target, result)}},
      {"OpenContender",
       sizeof(OpenContender),
       {MEMBER(OpenContender, target), MEMBER(OpenContender, object), MEMBER(OpenContender, triB),
        MEMBER(OpenContender, triA), MEMBER(OpenContender, a), MEMBER(OpenContender, b), MEMBER(OpenContender, pose)}},
      {"RadarResult",
       sizeof(radar::Result),
       {MEMBER(radar::Result, status), MEMBER(radar::Result, tier), MEMBER(radar::Result, detected),
        MEMBER(radar::Result, resolution), MEMBER(radar::Result, t), MEMBER(radar::Result, lo),
        MEMBER(radar::Result, hi), MEMBER(radar::Result, fraction), MEMBER(radar::Result, object),
        MEMBER(radar::Result, triB), MEMBER(radar::Result, triA), MEMBER(radar::Result, flags),
        MEMBER(radar::Result, point), MEMBER(radar::Result, normal), MEMBER(radar::Result, paperMinL)}},
      {"Placement",
       sizeof(Placement),
       {MEMBER(Placement, frameFromMesh), MEMBER(Placement, error), MEMBER(Placement, mesh), MEMBER(Placement, object),
        MEMBER(Placement, moved)}},
      {"Moved",
       sizeof(Moved),
       {MEMBER(Moved, object), MEMBER(Moved, mesh), MEMBER(Moved, firstByte), MEMBER(Moved, anchor),
        MEMBER(Moved, halfExtent)}},
      {"ClusterRef", sizeof(ClusterRef), {MEMBER(ClusterRef, placement), MEMBER(ClusterRef, node)}},
      {"RefBox", sizeof(RefBox), {MEMBER(RefBox, lo), MEMBER(RefBox, hi), MEMBER(RefBox, edge)}},
      {"PairItem",
       sizeof(PairItem),
       {MEMBER(PairItem, target), MEMBER(PairItem, firstA), MEMBER(PairItem, endA), MEMBER(PairItem, firstB),
        MEMBER(PairItem, endB)}},
      {"ClusterPair", sizeof(ClusterPair), {MEMBER(ClusterPair, gap), MEMBER(ClusterPair, a), MEMBER(ClusterPair, b)}},
      {"Contender",
       sizeof(Contender),
       {MEMBER(Contender, low), MEMBER(Contender, at), MEMBER(Contender, error), MEMBER(Contender, object),
        MEMBER(Contender, slotB), MEMBER(Contender, slotA), MEMBER(Contender, flags)}},
      {"State",
       sizeof(State),
       {MEMBER(State, hi), MEMBER(State, pairCount), MEMBER(State, contenderCount), MEMBER(State, progress),
        MEMBER(State, boxPairs), MEMBER(State, solved), MEMBER(State, round), MEMBER(State, cursor),
        MEMBER(State, spent), MEMBER(State, met), MEMBER(State, tiles)}},
      {"MaskItem",
       sizeof(MaskItem),
       {MEMBER(MaskItem, target), MEMBER(MaskItem, ref), MEMBER(MaskItem, firstPixel), MEMBER(MaskItem, firstOther),
        MEMBER(MaskItem, endOther)}},
  };
  std::set<std::string> seen;
  for (const auto& [shader, spirv] : kShaders) {
    const Layouts layouts = layoutsOf(spirv);
    for (const Expected& one : expected) {
      if (layouts.offsets.count(one.structure) == 0) continue;
      CAPTURE(shader, one.structure);
      seen.insert(one.structure);
      const auto& found = layouts.offsets.at(one.structure);
      CHECK(found.size() == one.members.size());
      for (const auto& [member, offset] : one.members) {
        CAPTURE(member);
        REQUIRE(found.count(member) == 1);
        CHECK(found.at(member) == offset);
      }
      REQUIRE(layouts.strides.count(one.structure) == 1);
      CHECK(layouts.strides.at(one.structure) == one.size);
    }
  }
  for (const Expected& one : expected) CHECK(seen.count(one.structure) == 1);
}

TEST_CASE("what uses doubles has a variant without") {
  constexpr uint32_t kOpTypeFloat = 22;
  for (const auto& [shader, spirv] : kShaders) {
    CAPTURE(shader);
    bool doubles = false;
    for (size_t at = 5; at < spirv.size(); at += spirv[at] >> 16) {
      doubles = doubles || ((spirv[at] & 0xffff) == kOpTypeFloat && spirv[at + 2] == 64);
    }
    const bool hasVariant =
        std::any_of(std::begin(kShaders), std::end(kShaders),
                    [name = std::string(shader)](auto& s) { return s.first == name + " without doubles"; });
    CHECK(doubles == hasVariant);
  }
}
