// Work in a process of its own, so that its crash costs nobody else anything.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace radar::tools {

struct ChildOutcome {
  std::string bytes;   ///< what the work returned
  std::string failed;  ///< how it ended instead; empty: it returned
  bool threw = false;  ///< whether `failed` is an exception's words
};

struct ChildLimits {
  unsigned seconds;             ///< of processor time, after which it is stopped
  uint64_t bytes = UINT64_MAX;  ///< of memory that it may take; more is std::bad_alloc to it
};

/// Runs `work` in a forked child, which ends with this process at the latest. An exception's words and a signal's name
/// end up in `failed`. In the child only the calling thread runs on, so `work` must not wait for another thread or for
/// a lock that one may hold, such as a Vulkan device's. Throws std::runtime_error where no child can be made.
ChildOutcome inChild(const std::function<std::string()>& work, const ChildLimits& limits);

}  // namespace radar::tools
