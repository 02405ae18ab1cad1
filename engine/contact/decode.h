// What a search left to the host becomes an answer: pairs too close for the device's arithmetic are decided by `exact`.
#pragma once

#include <span>

#include "scene/scene.h"
#include "shaders/contact/interop.h"

namespace radar {

/// The pairs that a device has left to the host, by the sensor: all of one, or none where there was no room.
class UnresolvedPairs {
 public:
  /// `pairs` stay where they are.
  explicit UnresolvedPairs(std::span<const gpu::UnresolvedPair> pairs);
  /// In the order of (object, triB, triA).
  std::span<const gpu::UnresolvedPair* const> of(uint32_t sensor) const;

 private:
  std::vector<const gpu::UnresolvedPair*> ordered_;
};

/// The answer where the device's own has the flag kFlagOpen and `pairs` are all that may be first; of a query that only
/// asks for a decision no more are decided than it takes. Throws Error with VK_ERROR_UNKNOWN if the search met
/// something that is not among them.
Result decideUnresolved(const Result& found, std::span<const gpu::UnresolvedPair* const> pairs, const Query& query);

/// Of a query that has nothing to meet.
Result clearAnswer();

}  // namespace radar
