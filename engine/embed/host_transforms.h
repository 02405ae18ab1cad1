// Layouts of a host's transforms: checked, measured, and encoded for shaders.
#pragma once

#include <string>

#include "radar/host_transforms.h"
#include "shaders/embed/interop.h"

namespace radar {

/// Empty if the layout is valid.
std::string validate(const TransformLayout& layout);
/// Bytes from a transform's beginning to the end of its last float.
uint64_t extentOf(const TransformLayout& layout);
gpu::TransformLayout encoded(const TransformLayout& layout);

}  // namespace radar
