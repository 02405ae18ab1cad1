// Lavapipe as if it were a discrete GPU, which has memory that the host cannot map.
#pragma once

#include "radar/device.h"

namespace radar::test {

/// The same device, with a loader in front of the system's: it says that the device is a GPU with three types of
/// memory, of the device, of the host, and of the host and cached. The first cannot be mapped.
HostDevice asGpu(HostDevice host);

}  // namespace radar::test
