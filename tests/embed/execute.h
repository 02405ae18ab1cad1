// A recording that is executed at once.
#pragma once

#include "gpu/submission.h"
#include "radar/recorder.h"
#include "support/answer.h"

namespace radar::test {

/// `queries`: Queries or HostQueries.
template <class Queries>
Answers execute(const Device& device, Recorder& recorder, const Queries& queries, const HostGeometry& geometry = {}) {
  gpu::Submission submission(device.impl(), false);
  recorder.record(submission.begin(), queries, geometry);
  submission.submitAndWait();
  return recorder.read();
}

}  // namespace radar::test
