// A recording that is executed at once.
#pragma once

#include <array>

#include "gpu/submission.h"
#include "radar/recorder.h"
#include "support/answer.h"

namespace radar::test {

/// Whether a Recorder takes a valid query: not if only the CPU combines what it asks for (radar/recorder.h).
inline bool isRecordable(const Query& query, const Scene& scene) {
  bool isMoving = false;
  for (ObjectId id = 0; id < scene.objectLimit(); ++id) {
    isMoving = isMoving || (scene.hasObject(id) && scene.object(id).motion != std::array<double, 3>{});
  }
  if (query.turn || query.closest || query.exit || query.skipOverlapping || (isMoving && !query.motion)) return false;
  return query.clearance == 0 || !(query.ignoreLeaving || query.hits > 1 || query.motion || isMoving);
}

/// `queries`: Queries or HostQueries.
template <class Queries>
Answers execute(const Device& device, Recorder& recorder, const Queries& queries, const HostGeometry& geometry = {}) {
  gpu::Submission submission(device.impl(), false);
  recorder.record(submission.begin(), queries, geometry);
  submission.submitAndWait();
  return recorder.read();
}

}  // namespace radar::test
