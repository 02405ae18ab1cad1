// Recordings over objects that a host moves on its device, and over queries that its shaders write.
#pragma once

#include "embed/host_world.h"
#include "soak/batch.h"
#include "soak/fault_plan.h"

namespace radar::soak {

class MovedAnswerers {
 public:
  MovedAnswerers(const Device& device, tools::Random& random, Tally& tally);

  /// Moves the objects, and asks. Throws std::logic_error if an answer is wrong.
  void round();

 private:
  std::vector<Query> choose();
  void change();
  template <class Queries>
  void ask(Who who, const Queries& recorded, std::span<const Query> queries);
  void tellAndAsk(const std::vector<Query>& queries);

  const Device* device_;
  tools::Random* random_;
  Tally* tally_;
  test::MovedWorld world_;
  SceneCopy copy_;
  Recorder recorder_, sharing_;
  Sweeper sweeper_;
};

}  // namespace radar::soak
