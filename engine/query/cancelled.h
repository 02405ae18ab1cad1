// Batches that are given up because their caller wants no more of them.
#pragma once

#include <stop_token>

#include "radar/answers.h"

namespace radar {

/// Thrown, and caught, within a batch whose stop has been requested. No std::exception, so that nothing takes it for a
/// failure.
struct Cancelled {};

inline void throwIfStopped(const std::stop_token& stop) {
  if (stop.stop_requested()) throw Cancelled();
}

/// Says of the queries without an answer that they were cancelled.
void cancelRest(Answers& answers);

}  // namespace radar
