// How headers that C++ and GLSL share declare constants and typed binding numbers.
#ifndef RADAR_SLOT_H
#define RADAR_SLOT_H

#ifdef __cplusplus
#include <cstdint>
namespace radar::gpu {

/// The number of a binding whose buffer has elements of type T (gpu/kernel.h).
template <class T>
struct Slot {
  uint32_t number;
};

/// Element type of a slot for an image with its sampler.
struct SampledImage;

}  // namespace radar::gpu
#define INTEROP_CONST inline constexpr uint32_t
// A Slot<type> in C++, a number in GLSL for `layout(binding = name)`.
#define INTEROP_SLOT(name, number, type) \
  inline constexpr ::radar::gpu::Slot<type> name { number }
#else
#define INTEROP_CONST const uint
#define INTEROP_SLOT(name, number, type) const uint name = number
#endif

#endif
