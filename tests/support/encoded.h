// What the device makes of stated searches.
#pragma once

#include <functional>
#include <vector>

#include "contact/pass.h"
#include "gpu/submission.h"
#include "support/buffer_words.h"
#include "support/test_device.h"

namespace radar::test {

struct Encoded {
  std::vector<gpu::Sensor> sensors;
  std::vector<gpu::Sweep> sweeps;
  std::vector<gpu::SearchState> states;
  std::vector<gpu::SearchTask> tasks;
  gpu::SearchCounts counts;
};

/// Encodes the `count` searches that `search` has staged. `before`: recorded between the upload and the encoding.
inline Encoded encodedBy(
    ContactPass& search, size_t count,
    const std::function<void(const gpu::Commands&)>& before = [](const gpu::Commands&) {}) {
  gpu::Submission submission(device().impl(), false);
  const gpu::Commands commands = submission.begin();
  search.recordUpload(commands, [](const char*) {});
  before(commands);
  search.recordEncoding(commands, [](const char*) {});
  submission.submitAndWait();
  Encoded encoded{elementsOf(search.sensors(), 0, count),
                  elementsOf(search.stated().sweeps, 0, count),
                  elementsOf(search.states(), 0, count),
                  {},
                  elementsOf(search.counts(), 0, 1)[0]};
  encoded.tasks = elementsOf(search.tasks(), 0, encoded.counts.rounds[0].tasks);
  return encoded;
}

/// The same for a batch of searches in a scene.
inline Encoded encodedBy(GpuScene& copy, const Scene::Impl& scene, const SearchPlan& batch) {
  ContactPass search(device().impl(), copy, {});
  const std::vector<Result> known(batch.count());
  copy.commit(search.stage(batch.source(), known, scene));
  return encodedBy(search, batch.count());
}

}  // namespace radar::test
