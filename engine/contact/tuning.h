// Every number that shapes the search on a device: loops, capacities, the division into dispatches and submissions.
// None changes an answer, so that any may be tried: radar-lab tune tries them on a device.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>

#include "gpu/device.h"

namespace radar {

/// Zero: chosen for the device and the batch.
struct SearchTuning {
  // Lists. Those that are too small cost answers by the CPU, or further submissions.
  uint32_t tasks = 0;       ///< in addition to one per search
  uint32_t candidates = 0;  ///< for all searches together
  uint32_t unresolved = 0;  ///< unresolved pairs; all of a search's pairs are listed, or none
  // Division.
  uint32_t searches = 0;  ///< of a submission, at most
  uint32_t rounds = 0;    ///< of each submission; an even number up to gpu::kMostRounds
  uint32_t groups = 0;    ///< workgroups per round
  uint32_t budget = 0;    ///< iterations of a workgroup per round
  uint32_t width = 0;     ///< below this number, tasks are split early:
  uint32_t split = 0;     ///< after so many iterations
  // A workgroup.
  uint32_t queue = 0;        ///< waiting pairs; at least six per lane
  uint32_t stack = 0;        ///< entries per lane; at least 4
  uint32_t objectSteps = 0;  ///< nodes of the tree over objects that a lane tests before the queues are looked at
  uint32_t nodeSteps = 0;    ///< likewise pairs of nodes of meshes
  uint32_t few = 0;          ///< fewer lanes (over objects, than half of this) leave such a loop to find work
  uint32_t leafBatch = 0;    ///< pairs of leaves that wait before they are tested
  bool countsWork = false;   ///< SearchCounts::done and steps
  /// The time, in place of the machine's: then the device is hurried (Pace), even if it runs on the CPU.
  std::function<std::chrono::steady_clock::time_point()> now;
};

/// `given`, brought into range, with all that does not depend on a batch, but for the budget, which a Pace may change.
SearchTuning tunedFor(const Device::Impl& device, SearchTuning given);

/// Of a batch, for a tuning from tunedFor(). `clearances`: some search has one. `wanted`: what earlier batches lacked.
uint32_t groupsFor(const SearchTuning& tuning, const Device::Impl& device, uint32_t searches);
uint32_t widthFor(const SearchTuning& tuning, const Device::Impl& device, uint32_t searches);
uint64_t taskRoomFor(const SearchTuning& tuning, const Device::Impl& device, uint32_t searches);
uint64_t candidateRoomFor(const SearchTuning& tuning, uint32_t searches, uint32_t wanted);
uint32_t unresolvedRoomFor(const SearchTuning& tuning, uint32_t searches, bool clearances, uint32_t wanted);

/// Candidates for which there is room unless told otherwise: see Capacity. Searches have some 10 among boxes, 30 among
/// meshes, hundreds where shapes interlock.
uint64_t usualCandidates(uint64_t searches);

/// Iterations of a workgroup in a round: below lavapipe's limit (shaders/contact/search.glsl), with room for what is
/// waiting when the budget ends; and so that a round is brief on any GPU.
inline constexpr uint32_t kMostBudget = 40'000, kBriefBudget = 1000;
/// Capacity for candidates, of 24 bytes and 64 as refined pairs, that lists grow to.
inline constexpr uint32_t kMostCandidates = 1u << 22;

}  // namespace radar
