// Lists of the first contacts with each object, put together from one search for each object in reach.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "radar/answers.h"
#include "radar/query.h"

namespace radar {

class HitLists {
 public:
  /// Begins the list of a query.
  void begin(size_t query) { lists_[query]; }
  /// Adds the answer of one object.
  void add(size_t query, const Result& answer);
  /// Records that an object's answer is missing.
  void giveUp(size_t query) { lists_[query].isComplete = false; }

  /// Calls `done` with each query and its `hits` nearest contacts by (t, object), and `failed` with each query whose
  /// list is incomplete, or whose order rounding leaves open. None is left afterwards.
  template <class Done, class Failed>
  void finish(std::span<const Query> queries, const Done& done, const Failed& failed) {
    for (auto& [query, list] : std::exchange(lists_, {})) {
      if (auto nearest = nearestOf(std::move(list), queries[query])) {
        done(query, std::move(*nearest));
      } else {
        failed(query);
      }
    }
  }

 private:
  struct List {
    std::vector<Result> searches;
    bool isComplete = true;
  };
  static std::optional<std::vector<Result>> nearestOf(List list, const Query& query);

  std::map<size_t, List> lists_;
};

}  // namespace radar
