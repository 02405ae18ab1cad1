// What a search found becomes a Result: pairs too close for the device's arithmetic are decided by `exact`.
#pragma once

#include "sweep/contact_recorder.h"

namespace radar {

/// Of a search that is done; where only a decision is asked, no more pairs than it takes are decided. Adds the pairs it
/// had to decide on the CPU to `cpuPairs`. Throws Error with VK_ERROR_UNKNOWN if the search met something that is not
/// among what it lists.
Result decodeContact(const Found& found, const Query& query, uint64_t& cpuPairs);

}  // namespace radar
