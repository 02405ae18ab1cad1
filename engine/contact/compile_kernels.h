// Which programs a device runs.
#pragma once

#include <string>
#include <vector>

#include "gpu/kernel.h"

namespace radar {

/// Those of queries of a mode, recorded ones included; not those that check a device's arithmetic.
std::vector<gpu::Program> programsOf(const Device::Impl& device, Mode mode);
/// "contact/search 32 256 40 1".
std::string nameOf(const gpu::Program& program);

}  // namespace radar
