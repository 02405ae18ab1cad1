// Converts the shaders' output to a Result.
#pragma once

#include <span>

#include "scene/scene.h"
#include "shaders/sampled/interop.h"

namespace radar {

/// The answer to a query with nothing in reach: certainly clear.
Result decodeClear();

/// The answer to a query whose scopes were drawn, in a window of `resolution`. Unresolved pairs that may come before
/// the device's contact are decided exactly, and counted in `cpuPairs`; for a query with `anyHit`, only until one
/// meets.
Result decodeSampled(const gpu::Answer& answer, std::span<const gpu::SampledUnresolved> unresolved, const Query& query,
                     const Scene::Impl& scene, uint32_t resolution, uint64_t& cpuPairs);

}  // namespace radar
