// A host's renderer, as far as searches go: its command buffer, and a pass of its own that reads the answers.
#pragma once

#include <span>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/pipeline.h"
#include "gpu/submission.h"
#include "radar/recorder.h"
#include "support/bindings.h"
#include "workloads/families.h"

namespace radar::test {

class Renderer {
 public:
  /// What its pass sees of an answer (tests/embed/read_results.comp).
  struct Seen {
    uint32_t status, object, flags;
    float t;
    float normal[3];
  };

  explicit Renderer(const Device& device);

  /// Records the queries, and behind the barrier that radar/recorder.h asks for the host's own pass.
  void record(Recorder& recorder, std::span<const Query> queries, bool withBarrier = true);
  void submit() { submission_.submit(); }
  void wait() { submission_.wait(); }
  void submitAndWait() { submission_.submitAndWait(); }
  const Seen& seen(size_t i) const { return reinterpret_cast<const Seen*>(seen_.mapped())[i]; }

 private:
  const Device::Impl& device_;
  gpu::Submission submission_;
  Bindings bindings_;
  gpu::Pipeline pipeline_;
  gpu::Buffer seen_;
};

/// Checks what the renderer's pass sees of an answer; returns whether it was left open.
bool isSeen(const Renderer::Seen& seen, const Result& expected);

/// A row of boxes, each a step behind the last, and turned ones as sensors, some of which pass them all.
struct Row {
  explicit Row(uint32_t sensors);
  Scene scene;
  MeshId mesh;
  std::vector<Query> queries;
};

/// The workload's queries, of mode contact.
std::vector<Query> queriesOf(const tools::Workload& workload);

}  // namespace radar::test
