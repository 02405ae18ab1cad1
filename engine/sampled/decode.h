// Completes the shaders' output to answers.
#pragma once

#include "radar/answers.h"
#include "radar/query.h"
#include "shaders/sampled/interop.h"

namespace radar {

/// The answer to a query with nothing in reach: certainly clear.
Result decodeClear();

/// The answer to a query whose scopes were drawn with so many pixels, from the device's `answer` and the first contact
/// among the proposed pairs.
Result decodeSampled(const gpu::Answer& answer, const Result& contact, const Query& query, uint32_t resolution);

}  // namespace radar
