// Merges the answers of searches past one object each.
#pragma once

#include <span>
#include <vector>

#include "radar/query.h"

namespace radar {

struct Merged {
  Result first;              ///< the query's answer
  std::vector<Result> hits;  ///< by (t, object): contacts, at most as many as asked for, and what may be one
  bool isCertain = true;     ///< whether nothing among the first ones is missing, open or in an order that rounding leaves open
};

/// `searches`: one or more, by ascending object. shaders/embed/gather.comp.glsl merges by the same key.
Merged merged(std::span<const Result> searches, uint32_t most);

}  // namespace radar
