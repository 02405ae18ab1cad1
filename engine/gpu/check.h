// A VkResult that is not success becomes a radar::Error naming the call.
#pragma once

#include <string>

#include "radar/radar.h"

namespace radar::gpu {

const char* resultName(VkResult result);

/// Throws if `result` is an error. `call` names what was called, with the size it asked for where there is one.
void check(VkResult result, const std::string& call);

}  // namespace radar::gpu
