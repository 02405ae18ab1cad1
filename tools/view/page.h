// Answers as a page for a browser: one file, which needs no network.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "view/cut.h"

namespace radar::tools {

/// What another mode says of a query.
struct OtherAnswer {
  std::string words;  ///< a sentence
  Result result;
};

/// What a page shows beside the answers themselves.
struct PageContent {
  std::string title;
  uint64_t queries = 0;                     ///< how many there are, if the workload has only the first of them
  std::map<uint32_t, std::string> reasons;  ///< by query: why it is invalid
  LeftOut left;
  ListedMoments moments;
  std::vector<LinksMet> links;             ///< of each query, if there are chains
  std::map<uint32_t, OtherAnswer> others;  ///< by query
  std::map<uint32_t, Scopes> scopes;       ///< by query
  /// What plays when the page is opened: a query, from its start to its contact, and then all at once.
  std::optional<uint32_t> tour;
};

/// The page, HTML. An answer for each query of the workload; an instance without a mesh (kNone) is left out, under the
/// numbers of the others. A scene of more than 100,000 objects, more than 10,000 queries and meshes of more than three
/// million triangles are cut, which the page says.
std::string pageOf(const Workload& workload, std::span<const Result> answers, const PageContent& content);

}  // namespace radar::tools
