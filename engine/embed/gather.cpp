#include "embed/gather.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "gpu/barrier.h"
#include "gpu/device.h"
#include "shaders/contact/interop.h"
#include "spirv/radar_shaders.h"

namespace radar {

namespace {

// As in gather.comp.glsl.
std::tuple<int, double> keyOf(const Result& result) {
  if (result.status == Status::invalid) return {1, 0};
  if (result.status == Status::undecided) return {2, result.lo};
  const bool isDecision = result.status == Status::hit && result.object == kNone;
  return isDecision ? std::tuple(0, 0.0) : std::tuple(2, result.t);
}

}  // namespace

Result gather(std::span<const Result> searches, uint32_t hits, std::vector<Result>& list) {
  std::vector<size_t> order(searches.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t p, size_t q) { return keyOf(searches[p]) < keyOf(searches[q]); });
  Result first = searches[order.front()];
  for (const Result& search : searches) {
    if (first.status == Status::invalid && search.status == Status::invalid) first.flags |= search.flags;
    if (first.status == Status::undecided && search.detected == Detected::yes) first.detected = Detected::yes;
  }
  for (size_t i = 0; i < std::min<size_t>(order.size(), hits); ++i) {
    if (searches[order[i]].status != Status::clear) list.push_back(searches[order[i]]);
  }
  return first;
}

GatherPass::GatherPass(const Device::Impl& device, uint32_t searches)
    : upload_(device),
      buffer_(device, "searches to gather", gpu::BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      run_(device, {shaders::kGather}) {
  buffer_.reserve(searches);
}

void GatherPass::stage() {
  run_.begin();
  upload_.begin(gpu::Upload::aligned(gpu::bytesOf(searches_)));
  upload_.add(searches_.data(), gpu::bytesOf(searches_), buffer_);
}

void GatherPass::record(const gpu::Commands& commands, const gpu::Array<Result>& results, uint32_t first) {
  gpu::computeWriteToComputeReadWrite(commands);
  run_(commands, shaders::kGather, gpu::groupsFor(searchCount(), gpu::kHostGroup),
       gpu::GatherPush{searchCount(), first}, {{gpu::kSlotResults, results}, {gpu::kSlotGathered, buffer_}});
}

}  // namespace radar
