// That a device has proved itself. The floor `proof` defines these: it asks Sweepers and Recorders, which ask it here.
#pragma once

#include "gpu/device.h"

namespace radar {

/// Throws Error with reasons if a Sweeper's answers to known queries are wrong; asks them once per device.
void requireProof(const Device::Impl& device);
/// The same, also of a Recorder's answers; but never asks a device without a queue.
void requireRecorderProof(const Device::Impl& device);

}  // namespace radar
