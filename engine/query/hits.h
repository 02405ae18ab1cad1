// The lists of a query, and the merging of searches past one object each.
#pragma once

#include <span>
#include <vector>

#include "radar/answers.h"
#include "radar/query.h"

namespace radar {

/// Whether a query lists more than its first contact.
inline bool hasLists(const Query& query) {
  return query.hits > 1 || query.skipOverlapping || query.closest || query.exit;
}

/// Makes room for the answers to `count` queries, and for their lists if they have some, in the memory that `answers`
/// has. Results that were there stay.
void makeRoom(size_t count, bool lists, Answers& answers);
/// Makes `answers` invalid ones to all queries, with room for their lists, in the memory that it has.
void clearFor(std::span<const Query> queries, unsigned threads, Answers& answers);
Answers unanswered(std::span<const Query> queries);

struct Merged {
  Result first;              ///< the query's answer
  std::vector<Result> hits;  ///< by (t, object): contacts, at most as many as asked for, and what may be one
  /// Whether nothing among the first ones is missing, open or in an order that rounding leaves open.
  bool isCertain = true;
};

/// `searches`: one or more, by ascending object. shaders/embed/gather.comp.glsl merges by the same key.
Merged merged(std::span<const Result> searches, uint32_t most);

}  // namespace radar
