// Casts as a page for a browser.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "python/batch.h"
#include "python/casting_scene.h"
#include "view/cut.h"

namespace radar::python {

/// What a page shows of casts: a number for each of them, or as many as stated, adjacent. Absent ids are -1.
struct ShownCasts {
  uint64_t count = 0;  ///< of casts; there may be fewer names, and of each array as many as names
  std::vector<std::string> names;
  const uint32_t* meshes = nullptr;
  const double *poses = nullptr, *directions = nullptr, *distances = nullptr;  ///< 16, 3, 1
  const double* clearances = nullptr;
  const uint8_t* anyHit = nullptr;    ///< whether only that is known
  const int64_t* excluded = nullptr;  ///< `excludedCount` of them
  size_t excludedCount = 0;
  BatchOutput answers{};
  std::map<uint32_t, std::string> reasons;  ///< by cast
  tools::LeftOut left;                      ///< by cast
};

/// The page, HTML, of a scene as it is now.
std::string pageOf(const CastingScene& scene, const std::map<uint32_t, std::string>& objectNames,
                   const std::string& title, const ShownCasts& casts);

}  // namespace radar::python
