// Decides the unresolved pairs of a search exactly: those that are too close for the device's arithmetic.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <stop_token>

#include "exact/motion.h"
#include "math/vector.h"
#include "query/hits.h"
#include "radar/answers.h"
#include "radar/query.h"
#include "scene/scene.h"
#include "shaders/contact/interop.h"

namespace radar {

/// The pairs that a device leaves to the CPU, by sensor: those that may be first (all, or none if there was no room),
/// or that of an overlap, whose point is missing.
class UnresolvedPairs {
 public:
  /// `pairs` must outlive this, in place.
  explicit UnresolvedPairs(std::span<const gpu::UnresolvedPair> pairs);
  /// Ordered by (object, triB, triA). None if `found`, the sensor's answer, stands.
  std::span<const gpu::UnresolvedPair* const> of(uint32_t sensor, const Result& found) const;
  /// Those of each search, whether its answer stands or not.
  std::vector<std::span<const gpu::UnresolvedPair* const>> bySearch() const;

 private:
  std::vector<const gpu::UnresolvedPair*> ordered_;
};

/// The answer to a query from its device answer `found` and `pairs`, at least one, of UnresolvedPairs.
/// `motion`: that of the search. For a query with `anyHit`, stops at the first pair that meets. `tolerance`: of its
/// clearance (cpu/clearance.h).
/// Throws Error (internal) if the search found a certain contact, but none of `pairs` meets. `farthest`:
/// Mesh::farthest of the meshes that were searched.
Result decideUnresolved(const Result& found, std::span<const gpu::UnresolvedPair* const> pairs, const Query& query,
                        const Motion& motion, double tolerance, std::span<const Vector> farthest);

/// A search that may be left open: what decideUnresolved() needs.
struct OpenSearch {
  Result& result;
  Query query;
  Motion motion;
  double tolerance = 0;
};

struct Deciding {
  std::span<const Vector> farthest;  ///< as of decideUnresolved()
  size_t most = std::numeric_limits<size_t>::max();
  unsigned threads = 1;
  std::stop_token stop = {};
};

/// Decides the searches that are left open, in place, but for those with more than `most` pairs. `ask`: of a search,
/// with the object of one of its pairs; called on several threads. Returns how many pairs were decided. Throws
/// Cancelled soon after the stop is requested.
uint64_t decideAll(std::span<const gpu::UnresolvedPair> pairs, const Deciding& how,
                   const std::function<OpenSearch(uint32_t search, ObjectId object)>& ask);

/// The answer to a query with nothing in reach.
Result clearAnswer();

/// The answer to a query from those of its searches: one or, by ascending object, several.
/// Nothing if only the CPU can tell.
std::optional<Merged> certainAnswer(const Query& query, const Scene::Impl& scene, std::span<const Result> searches);

}  // namespace radar
