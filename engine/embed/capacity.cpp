#include "embed/capacity.h"

#include <algorithm>

#include "contact/pass.h"

namespace radar {

namespace {

constexpr uint32_t kRounds = 16;

// Without doubles, every contact is left to the CPU.
uint64_t usualUnresolved(uint64_t searches, bool doubles) {
  const uint64_t most = doubles ? std::max(std::min(16 * searches, uint64_t{1} << 14), searches) : 16 * searches;
  return std::max(std::min(128 * searches, uint64_t{1} << 13), most);
}

}  // namespace

Capacity completed(Capacity capacity, const Device::Impl& device) {
  const uint64_t limit = device.properties.limits.maxStorageBufferRange;
  const uint64_t candidates = limit / sizeof(gpu::RefinedPair), unresolved = limit / sizeof(gpu::UnresolvedPair);
  const auto limitTo = [](const char* what, uint64_t got, uint64_t most) {
    if (got <= most) return;
    throw Error(std::string("Capacity::") + what + ": this device allows " + std::to_string(most) + ", got " +
                std::to_string(got));
  };
  limitTo("queries", capacity.queries, limit / sizeof(gpu::Sweep));
  limitTo("searches", capacity.searches, (limit / sizeof(gpu::Sweep) - capacity.queries) / 2);
  limitTo("candidates", capacity.candidates, candidates);
  limitTo("rounds", capacity.rounds, gpu::kMostRounds);
  limitTo("unresolvedPairs", capacity.unresolvedPairs, unresolved);
  if (capacity.rounds % 2 != 0) {
    throw Error("Capacity::rounds: expected an even number, got " + std::to_string(capacity.rounds));
  }
  if (capacity.rounds == 0) capacity.rounds = kRounds;
  const uint64_t searches = uint64_t{capacity.queries} + capacity.searches;
  const auto choose = [](uint32_t& member, uint64_t usual, uint64_t most) {
    if (member == 0) member = static_cast<uint32_t>(std::clamp<uint64_t>(usual, 1, most));
  };
  choose(capacity.candidates, usualCandidates(searches), candidates);
  choose(capacity.unresolvedPairs, usualUnresolved(searches, device.doubles), unresolved);
  return capacity;
}

}  // namespace radar
