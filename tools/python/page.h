// Casts as a page for a browser.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "python/batch.h"
#include "python/casting_scene.h"
#include "view/cut.h"
#include "workloads/query_fields.h"

namespace radar::python {

/// What a page shows of casts: a number for each of them, or as many as stated, adjacent. Absent ids are -1.
struct ShownCasts {
  uint64_t count = 0;  ///< of casts; there may be fewer names, and of each array as many as names
  std::vector<std::string> names;
  const uint32_t* meshes = nullptr;
  const double *poses = nullptr, *directions = nullptr, *distances = nullptr;  ///< 16, 3, 1
  std::vector<std::pair<const tools::QueryField*, const double*>>
      options;                        ///< values as setValue takes them, but 0: the word
  const int64_t* excluded = nullptr;  ///< `excludedCount` of them
  size_t excludedCount = 0;
  BatchOutput answers{};
  BatchOutput hits{};                       ///< those of cast i begin at hitOffsets[i] and end before hitOffsets[i + 1]
  const int64_t* hitOffsets = nullptr;      ///< null: none is listed
  std::map<uint32_t, std::string> reasons;  ///< by cast
  tools::LeftOut left;                      ///< by cast
};

/// The page, HTML, of a scene as it is now.
std::string pageOf(const CastingScene& scene, const std::map<uint32_t, std::string>& objectNames,
                   const std::string& title, const ShownCasts& casts);

}  // namespace radar::python
