// The answers of recordings to known queries (sweep/known_answers.h).
#pragma once

#include "gpu/device.h"

namespace radar {

/// Queries of the CPU and of a host's shaders, beside a host's geometry.
std::vector<AnswerCheck> checkRecorder(const Device::Impl& device, uint64_t seed);
/// Throws Error with reasons if a Recorder's answers to kProofs scenes are wrong; asks them once per device, and never
/// of one without a queue.
void requireRecorderProof(const Device::Impl& device);

}  // namespace radar
