// Completes the shaders' output to answers.
#pragma once

#include "contact/decode.h"
#include "shaders/sampled/interop.h"

namespace radar {

/// The answer to a query with nothing in reach: certainly clear.
Result decodeClear();

/// The answer to a query whose scopes were drawn with so many pixels, from the device's `answer`, the first contact
/// among the proposed pairs, and its open ones, which are decided exactly.
Result decodeSampled(const gpu::Answer& answer, const Result& contact, std::span<const gpu::UnresolvedPair* const> open,
                     const Query& query, uint32_t resolution);

}  // namespace radar
