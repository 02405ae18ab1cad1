#include "embed/capacity.h"

#include <algorithm>

#include "shaders/contact/interop.h"

namespace radar {

namespace {

// Capacity of a list, and rounds, if the host does not choose them.
struct ListRoom {
  uint64_t perQuery;  // what interlocking meshes of some thousand triangles need
  uint64_t most;      // in total, as long as that leaves `least` per query
  uint64_t least;
};
constexpr ListRoom kCandidates{1u << 11, 1u << 20, 64}, kUnresolved{1u << 7, 1u << 15, 4},
    kUnresolvedWithoutDoubles{1u << 10, 1u << 18, 32};  // which leave every contact to the CPU
constexpr uint32_t kRounds = 16;

uint32_t roomOf(const ListRoom& room, uint64_t queries, uint64_t limit) {
  const uint64_t wanted = std::max(std::min(room.perQuery * queries, room.most), room.least * queries);
  return static_cast<uint32_t>(std::clamp<uint64_t>(wanted, 1, limit));
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
  if (capacity.candidates == 0) capacity.candidates = roomOf(kCandidates, searches, candidates);
  if (capacity.unresolvedPairs == 0) {
    capacity.unresolvedPairs = roomOf(device.doubles ? kUnresolved : kUnresolvedWithoutDoubles, searches, unresolved);
  }
  return capacity;
}

}  // namespace radar
