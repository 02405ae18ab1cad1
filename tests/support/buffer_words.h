// Reads buffers of the device back.
#pragma once

#include <cstring>
#include <vector>

#include "gpu/buffer.h"

namespace radar::test {

/// The first `count` words of a storage buffer of test::device(), which must be idle.
std::vector<uint32_t> wordsOf(VkBuffer buffer, size_t count);

/// Elements `first` to `first + count - 1`.
template <class T>
std::vector<T> elementsOf(VkBuffer buffer, size_t first, size_t count) {
  const std::vector<uint32_t> words = wordsOf(buffer, (first + count) * sizeof(T) / 4);
  std::vector<T> elements(count);
  if (count != 0) std::memcpy(static_cast<void*>(elements.data()), &words[first * sizeof(T) / 4], count * sizeof(T));
  return elements;
}
template <class T>
std::vector<T> elementsOf(const gpu::Array<T>& array, size_t first, size_t count) {
  return elementsOf<T>(array.get(), first, count);
}

}  // namespace radar::test
