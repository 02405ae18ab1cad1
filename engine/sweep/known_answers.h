// Scenes and queries whose answers the CPU knows, by which a device proves itself: an optimiser of its driver, or
// shaders from a stale cache, may compute wrongly what the checks of its arithmetic (gpu/arithmetic.h) find right.
#pragma once

#include <functional>

#include "gpu/device.h"
#include "radar/answers.h"
#include "radar/scene.h"

namespace radar {

/// Boxes on a lattice, jagged bodies, needles and sheets, turned and sheared, whose meshes have origins of their own:
/// near the origin if `seed` is even, else 65,536 units from it. The poses of objects are floats.
struct KnownScene {
  explicit KnownScene(uint64_t seed);
  Scene scene;
  std::vector<MeshId> meshes;
  std::vector<Query> queries;
};

/// The seeds of the scenes by which a device proves itself.
inline constexpr uint64_t kProofs = 2;

/// What `check` returns. If it throws an internal error, to which only the device's answers can lead, all `asked` are
/// wrong.
AnswerCheck orAllWrong(const char* kind, size_t asked, const std::function<AnswerCheck()>& check);
/// Compares answers with the CPU's, to the bit. `places`: the device has placed the geometry (sweep/difference.h).
AnswerCheck compared(const char* kind, std::vector<Result> found, std::span<const Result> exact, bool places = false);
/// Mode contact's answers of a Sweeper: first contacts, lists, steps, and with `clearances` those with a clearance.
std::vector<AnswerCheck> checkSweeper(const Device::Impl& device, uint64_t seed, bool clearances);
/// Mode sampled's: each bracket holds the exact distance.
AnswerCheck checkSampled(const Device::Impl& device, uint64_t seed);
/// Throws Error, naming the device, if a check failed; the reasons say at which stage, and what differs.
void requirePassed(const Device::Impl& device, std::span<const AnswerCheck> checks);
/// The same if a Sweeper's answers to `kProofs` scenes are wrong; asks them once per device.
void requireProof(const Device::Impl& device);

}  // namespace radar
