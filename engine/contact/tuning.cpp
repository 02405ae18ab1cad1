#include "contact/tuning.h"

#include <algorithm>

#include "scene/parallel.h"
#include "shaders/contact/interop.h"

namespace radar {

namespace {

// Searches of one submission, at most: what a device has in hand while the next ones are listed. An NVIDIA H200 takes
// half as long for 131,072 searches in two submissions as in eight, each of which ends with few lanes at work.
constexpr uint32_t kSearches = 1u << 16, kSearchesOnCpu = 1u << 14;
// At first, and when these did not suffice (Rounds).
constexpr uint32_t kRounds = 8;
// Tasks, of 20 bytes in two lists: at most, in addition to two per search. The search makes do with less than what all
// stacks hold (search.glsl).
constexpr uint32_t kMostTasks = 1u << 18;
// Lanes that search at once on a GPU, with queues of 320 bytes each: for each search, at least, and at most; of very
// many searches, a quarter. An NVIDIA H200 searched 256 times in 0.79 ms with 2,048 lanes, and in 1.2 with 65,536.
constexpr uint32_t kLanes = 8, kLeastLanes = 1u << 10, kMostLanes = 1u << 14, kMostOfAll = 1u << 15;
// Subgroups have no more queues than so many lanes need: smaller ones take more workgroups.
constexpr uint32_t kLeastGroup = 16;
// Capacity for unresolved pairs, of 192 bytes: at first per search, and at most in total.
constexpr uint32_t kUnresolved = 4, kUnresolvedWithClearance = 16, kMostUnresolved = 1u << 20;
// With loops of 4 and 8 steps, an H200 searched in 0.93 (boxes), 0.90 (teapots), 0.82 (a million boxes) and 0.83 (pegs)
// of the time that it took with 16 and 24.
constexpr uint32_t kObjectSteps = 4, kNodeSteps = 8, kObjectStepsOnCpu = 16, kNodeStepsOnCpu = 24;
constexpr uint32_t kSplit = 48, kStack = 40;

void choose(uint32_t& value, uint32_t chosen) {
  if (value == 0) value = chosen;
}

}  // namespace

SearchTuning tunedFor(const Device::Impl& device, SearchTuning tuning) {
  const uint32_t lanes = device.subgroupSize;
  const bool onCpu = device.runsOnCpu();
  choose(tuning.searches, onCpu ? kSearchesOnCpu : kSearches);
  choose(tuning.rounds, kRounds);
  tuning.rounds = std::min((tuning.rounds + 1) / 2 * 2, gpu::kMostRounds);
  choose(tuning.split, kSplit);
  choose(tuning.queue, std::max(8 * lanes, 128u));
  tuning.queue = std::max(tuning.queue, 6 * lanes);
  choose(tuning.stack, kStack);
  tuning.stack = std::max(tuning.stack, 4u);
  choose(tuning.objectSteps, onCpu ? kObjectStepsOnCpu : kObjectSteps);
  choose(tuning.nodeSteps, onCpu ? kNodeStepsOnCpu : kNodeSteps);
  choose(tuning.few, (lanes + 1) / 2);
  choose(tuning.leafBatch, tuning.queue / 4);
  // A queue with room for less takes no more.
  tuning.leafBatch = std::min(tuning.leafBatch, tuning.queue - 2 * lanes);
  return tuning;
}

uint32_t groupsFor(const SearchTuning& tuning, const Device::Impl& device, uint32_t searches) {
  if (tuning.groups != 0) return tuning.groups;
  if (device.runsOnCpu()) return std::max(32u, searches / 256);
  const uint64_t lanes =
      std::max<uint64_t>(std::clamp(uint64_t{kLanes} * searches, uint64_t{kLeastLanes}, uint64_t{kMostLanes}),
                         std::min(searches / 4, kMostOfAll));
  return static_cast<uint32_t>(lanes / std::max(device.subgroupSize, kLeastGroup));
}

uint32_t widthFor(const SearchTuning& tuning, const Device::Impl& device, uint32_t searches) {
  if (tuning.width != 0) return tuning.width;
  // On the CPU, as many lanes are at work as threads times the width of a vector.
  const uint32_t groups = device.runsOnCpu() ? threadCount(0) : groupsFor(tuning, device, searches);
  return 2 * groups * device.subgroupSize;
}

uint64_t taskRoomFor(const SearchTuning& tuning, const Device::Impl& device, uint32_t searches) {
  const uint64_t all = uint64_t{groupsFor(tuning, device, searches)} * device.subgroupSize * (tuning.stack + 1);
  return searches + (tuning.tasks != 0 ? tuning.tasks : std::min<uint64_t>(all, uint64_t{kMostTasks} + searches));
}

uint64_t candidateRoomFor(const SearchTuning& tuning, uint32_t searches, uint32_t wanted) {
  return tuning.candidates != 0 ? tuning.candidates : std::max<uint64_t>(usualCandidates(searches), wanted);
}

uint32_t unresolvedRoomFor(const SearchTuning& tuning, uint32_t searches, bool clearances, uint32_t wanted) {
  if (tuning.unresolved != 0) return tuning.unresolved;
  const uint32_t usual = (clearances ? kUnresolvedWithClearance : kUnresolved) * searches;
  return std::clamp(std::max(usual, wanted), 4096u, kMostUnresolved);
}

uint64_t usualCandidates(uint64_t searches) {
  return std::max({std::min(searches << 11, uint64_t{1} << 15), std::min(64 * searches, uint64_t{3} << 15),
                   std::min(12 * searches, uint64_t{3} << 16), 2 * searches});
}

}  // namespace radar
