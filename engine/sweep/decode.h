// What the shaders wrote becomes a Result.
#pragma once

#include "scene/scene.h"
#include "shaders/interop.h"

namespace radar {

/// Of a sensor with nothing in reach: certainly clear.
Result decodeClear();

/// Of a sensor whose scopes were drawn; `resolution` is its window's.
Result decode(const gpu::Answer& answer, const Query& query, const Scene::Impl& scene, uint32_t resolution);

}  // namespace radar
