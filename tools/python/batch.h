// A batch of casts: arrays in, arrays out, with no object for each cast.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "python/casting_scene.h"

namespace radar::python {

/// What an array gives to each query of a batch: adjacent numbers, found by the strides of the leading dimensions
/// (bytes; 0 along a dimension that is broadcast).
struct PerQuery {
  const char* data = nullptr;
  std::vector<ptrdiff_t> strides;
};

struct BatchInput {
  std::vector<size_t> shape;       ///< of the leading dimensions
  PerQuery meshes;                 ///< uint32_t
  PerQuery poses;                  ///< 16 doubles; the last row is 0 0 0 1
  PerQuery displacements;          ///< 3 doubles
  PerQuery distances;              ///< double; without data, each goes to the end of its displacement
  PerQuery axes, angles, centres;  ///< 3 doubles, one, 3; without data, nothing turns
  PerQuery masks;                  ///< uint32_t
  PerQuery excluded;               ///< int64_t, `excludedCount` of them; below 0: none
  size_t excludedCount = 0;
  PerQuery leaving;             ///< bool; without data, as `options` says; likewise the next four
  PerQuery slacks, tolerances;  ///< double, NaN for none
  PerQuery clearances;          ///< double
  PerQuery hits;                ///< uint32_t, 0 for all; if one is above 1, so is options.hits
  tools::QuerySpec options;     ///< for the members that all queries share
  tools::AnswerMode mode = tools::AnswerMode::contact;

  size_t count() const;
};

/// What the answers of a batch list: nothing unless the queries ask for it.
struct BatchLists {
  /// Those of query i are entries hitOffsets[i] to hitOffsets[i + 1] of `hits`, records; likewise what overlaps.
  std::string hits;
  std::vector<int64_t> hitOffsets{0}, overlapping, overlappingOffsets{0};
  /// Of each query: the least distance's bracket, and records of where it is and of the last contact.
  std::vector<double> distanceLo{}, distanceHi{};
  std::string closest{}, exits{};
  std::map<std::string, std::vector<int64_t>> reasons;  ///< why queries are invalid, and which
};

/// Answers the batch in chunks, as records of castsLayout(): `records` has room for them. After each, `afterChunk` gets
/// the number of queries answered. While this waits for one, `look`, if there is one, is called about every 50 ms: by
/// one thread at a time of the process. What either throws ends the batch soon. A query that breaks its contract
/// becomes Status::invalid.
BatchLists cast(CastingScene& scene, const BatchInput& input, char* records, const std::function<void()>& look,
                const std::function<void(size_t)>& afterChunk);

}  // namespace radar::python
