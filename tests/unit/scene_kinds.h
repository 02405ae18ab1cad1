// Kinds of scenes, each with queries through them, about which the CPU is held against brute force, and every device
// against the CPU.
#pragma once

#include <span>

#include "soups.h"

namespace kinds {

using radar::test::Case;
using soups::Random;

struct Kind {
  const char* name;
  void (*make)(Random& random, Case& out);
  uint64_t judged;     ///< how many scenes are held against brute force, which is slow
  uint64_t compared;   ///< how many are asked of a device
  int contacts;        ///< the least number of hits and overlaps in those judged, to show that the kind serves
  double off = 1e-13;  ///< how far the point of an overlap may be off its triangles, as a share of their coordinates
};
std::span<const Kind> all();

/// A step, in which objects move, too: of about the size `scale`, `far` from the origin.
void makeStep(Random& random, double scale, double far, Case& out);

/// Lets a query ask for more: what counts as a contact, and for how many.
void vary(Random& random, radar::Query& query);

}  // namespace kinds
