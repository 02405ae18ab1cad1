// Decides the unresolved pairs of a search exactly: those that are too close for the device's arithmetic.
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <stop_token>

#include "exact/translation.h"
#include "math/vector.h"
#include "query/hits.h"
#include "radar/answers.h"
#include "radar/query.h"
#include "scene/scene.h"
#include "shaders/contact/interop.h"

namespace radar {

/// A search that may be left open.
struct OpenSearch {
  Result& result;        ///< as the device found it, then decided
  Query query;           ///< with `anyHit`, any pair that meets decides
  Translation motion;    ///< of the search
  double tolerance = 0;  ///< of the query's clearance (cpu/clearance.h)
};

struct Deciding {
  std::span<const Vector> farthest = {};  ///< Mesh::farthest of the meshes, if a query ignores what leaves
  size_t most = std::numeric_limits<size_t>::max();
  unsigned threads = 1;
  std::stop_token stop = {};
};

/// Decides the searches that the device left open, in place, but for those with more than `most` pairs. `pairs`: all,
/// or none if there was no room, that may be first in such a search, and that of an overlap whose point is missing.
/// `ask`: of a search, with the object of one of its pairs; called on several threads. Returns how many pairs were
/// decided. Throws Cancelled soon after the stop is requested, and an internal Error if a search found a certain
/// contact, but none of its pairs meets.
uint64_t decideAll(std::span<const gpu::UnresolvedPair> pairs, const Deciding& how,
                   const std::function<OpenSearch(uint32_t search, ObjectId object)>& ask);

/// The answer to a query with nothing in reach.
Result clearAnswer();

/// Makes the answer to a query, and its hits if it lists several, of those of its searches: one or, by ascending
/// object, several. Returns false, and makes none, if only the CPU can tell.
bool answerFrom(std::span<const Result> searches, const Query& query, const Scene::Impl& scene, Result& answer,
                std::vector<Result>& hits);

}  // namespace radar
