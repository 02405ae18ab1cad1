#pragma once

#include <unistd.h>

#include <cstddef>
#include <fstream>

namespace radar::test {

/// Bytes of this process in main memory.
inline size_t residentBytes() {
  size_t all = 0, pages = 0;
  std::ifstream("/proc/self/statm") >> all >> pages;
  return pages * static_cast<size_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace radar::test
