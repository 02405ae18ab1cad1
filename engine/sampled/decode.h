// What the shaders wrote becomes a Result.
#pragma once

#include <span>

#include "scene/scene.h"
#include "shaders/interop.h"

namespace radar {

/// Of a sensor with nothing in reach: certainly clear.
Result decodeClear();

/// Of a sensor whose scopes were drawn; `resolution` is its window's. Open pairs that may come before what the device
/// found are decided exactly, and counted in `cpuPairs`; where only a decision is asked, no more than it takes.
Result decodeSampled(const gpu::Answer& answer, std::span<const gpu::OpenPair> open, const Query& query,
                     const Scene::Impl& scene, uint32_t resolution, uint64_t& cpuPairs);

}  // namespace radar
