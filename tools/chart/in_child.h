// Work in a process of its own, so that its crash costs nobody else anything.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace radar::tools {

struct ChildOutcome {
  std::vector<double> values;  ///< what the work returned
  std::string failed;          ///< how it ended instead; empty: it returned
};

/// Runs `work` in a forked child, which is stopped after so many seconds of processor time. An exception's words and a
/// signal's name end up in `failed`. Throws std::runtime_error where no child can be made.
ChildOutcome inChild(const std::function<std::vector<double>()>& work, unsigned mostSeconds);

}  // namespace radar::tools
