// Are a device's doubles those of IEEE 754? Vulkan asks little of them.
#pragma once

#include "gpu/device.h"

namespace radar::gpu {

/// Adds, multiplies, divides and places (Pose's formula) with fixed numbers on the device, whose feature shaderFloat64
/// is enabled, and compares with the host, bit for bit. Submits to the device's queue, which it has, and waits.
bool doublesAreRight(const Device::Impl& device);

}  // namespace radar::gpu
