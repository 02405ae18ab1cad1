// The end of the contact tier: what the searches have met becomes answers, on the device. Owns its pipeline, the
// answers and the list of what is left to the host.
#pragma once

#include <vector>

#include "gpu/pipeline.h"
#include "sweep/resident_scene.h"

namespace radar {

class TellRecorder {
 public:
  /// `openContenders`: room for so many at first.
  TellRecorder(const Device::Impl& device, const ResidentScene& resident, uint32_t openContenders);

  /// What the contact tier lends, to be read.
  struct Lent {
    const gpu::Buffer &targets, &states, &contenders;
  };
  /// Contenders that searches told of together may have, and each of them: all may turn out to be open.
  uint64_t mostContenders() const;
  uint64_t mostOfOne() const;
  /// Makes room for so many answers. The device is idle.
  void prepare(uint32_t results);
  /// Behind the searches; a barrier from compute shaders to what reads the answers comes next.
  void record(const gpu::Commands& commands, const Lent& lent, uint32_t targets);

  /// Result, where each Target says.
  const gpu::Buffer& results() const { return results_; }

  // Once the device is done:
  bool allListed() const;
  /// Makes room for all that was open; returns whether there was already, or else record() has to be done again.
  bool makeRoom();
  /// What is open, in order of (target, object, triB, triA); valid until the device works again.
  const std::vector<const gpu::OpenContender*>& open();

 private:
  uint32_t capacity() const;
  const gpu::OpenCount& count() const;

  const Device::Impl* device_;
  const ResidentScene& resident_;
  uint32_t lanes_;  ///< of each search
  gpu::Bindings bindings_;
  gpu::Pipeline pipeline_;
  gpu::Buffer results_;
  gpu::Buffer open_;  ///< on the host: hardly ever is anything open
  std::vector<const gpu::OpenContender*> ordered_;
};

}  // namespace radar
