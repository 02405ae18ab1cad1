// What one query lists besides its first contact, while a batch is being answered.
#pragma once

#include <span>
#include <vector>

#include "radar/query.h"

namespace radar {

struct QueryLists {
  std::vector<Result> hits;           ///< by (t, object)
  std::vector<ObjectId> overlapping;  ///< ascending
};

inline bool hasLists(const Query& query) {
  return query.hits > 1 || query.skipOverlapping;
}

/// One entry for each query, or none if no query has lists.
std::vector<QueryLists> listsFor(std::span<const Query> queries);

/// All lists in the order of the queries; empty if `lists` is.
Lists joined(std::span<const QueryLists> lists);

}  // namespace radar
