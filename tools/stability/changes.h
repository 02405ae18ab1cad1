// Without a reference: what leaves the first contact where it is must leave every answer within its bracket.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "stability/case_run.h"

namespace radar::tools {

enum class Change { moved, swapped, cut, farObjects, split };
inline constexpr size_t kChanges = 5;
const char* nameOf(Change change);

struct ChangeRow {
  Change change = Change::moved;
  Method method = Method::contact;  ///< not the paper's, which has no bracket
  uint64_t cases = 0;
  uint64_t contacts = 0;  ///< cases in which it finds one
  uint64_t broken = 0;    ///< the two answers cannot both be right
};

struct ChangeSettings {
  uint32_t cases = 1024;
  uint64_t seed = 1;
  uint32_t resolution = 64;  ///< of all modes but contact
};

/// Whether a contact can lie in both brackets, or be missing from both. `undecided` agrees with what lies beyond its
/// lo.
bool agree(const Result& one, const Result& other);

/// `onBroken` receives the change, the method and the case's number; `onProgress` the number of cases just done.
std::vector<ChangeRow> measureChanges(const Device& device, const ChangeSettings& settings,
                                      const std::function<void(const std::string&)>& onBroken,
                                      const std::function<void(uint64_t)>& onProgress);

}  // namespace radar::tools
