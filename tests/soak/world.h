// Scenes that random edits change, and valid queries about them.
#pragma once

#include <memory>
#include <string>

#include "radar/query.h"
#include "workloads/random.h"

namespace radar::soak {

class World {
 public:
  virtual ~World() = default;
  virtual const Scene& scene() const = 0;
  /// Makes some edits.
  virtual void edit() = 0;
  /// At most so many valid queries of mode contact.
  virtual std::vector<Query> queries(uint32_t most) = 0;
  virtual std::string name() const = 0;
};

/// Hard cases, interlocking shapes or soups at any distance, whose poses, positions and motions change.
std::unique_ptr<World> makeHardWorld(tools::Random& random);
/// The scene of the fuzz targets, with numbers from anywhere.
std::unique_ptr<World> makeWildWorld(tools::Random& random);

}  // namespace radar::soak
