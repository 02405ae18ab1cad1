// The limits of a recording.
#pragma once

#include "gpu/device.h"
#include "radar/recorder.h"

namespace radar {

/// The capacity, with lists of a length of our choice where the host gives none. Throws Error, naming the member, if it
/// breaks its contract or the device's buffers cannot hold it.
Capacity completed(Capacity capacity, const Device::Impl& device);

}  // namespace radar
