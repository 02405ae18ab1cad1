// The part of a host's renderer that deals with searches: a command buffer and a compute pass that reads the answers.
#pragma once

#include <span>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/kernel.h"
#include "gpu/submission.h"
#include "radar/recorder.h"
#include "support/bindings.h"
#include "workloads/hard_cases.h"

namespace radar::test {

/// The families of hard cases that a Recorder answers: those whose numbers floats can hold, which are all but
/// `distance`, and whose queries list nothing.
inline std::vector<tools::HardFamily> recordableFamilies() {
  std::vector<tools::HardFamily> families = tools::hardFamilies();
  std::erase_if(families,
                [](const tools::HardFamily& family) { return family.name == "distance" || family.skipsOverlapping; });
  return families;
}

class Renderer {
 public:
  /// An answer as the host's pass reads it (tests/embed/read_results.comp).
  struct ShaderResult {
    uint32_t status, object, flags;
    float t;
    float free;  ///< of a distance of 3
    float normal[3];
  };

  explicit Renderer(const Device& device);

  /// Records the queries, the barrier that radar/recorder.h requires, and the host's own pass.
  void record(Recorder& recorder, std::span<const Query> queries, bool withBarrier = true);
  void submit() { submission_.submit(); }
  void wait() { submission_.wait(); }
  void submitAndWait() { submission_.submitAndWait(); }
  const ShaderResult& shaderResult(size_t i) const {
    return reinterpret_cast<const ShaderResult*>(shaderResults_.mapped())[i];
  }

 private:
  const Device::Impl& device_;
  gpu::Submission submission_;
  Bindings bindings_;
  gpu::Pipeline pipeline_;
  gpu::Buffer shaderResults_;
};

/// Checks an answer that the host's pass has read; returns whether it is unresolved.
bool checkShaderResult(const Renderer::ShaderResult& found, const Result& expected);

/// A row of boxes, each farther away than the previous one, and rotated boxes as sensors, some of which miss them all.
struct Row {
  explicit Row(uint32_t sensors);
  Scene scene;
  MeshId mesh;
  std::vector<Query> queries;
};

/// The workload's queries in mode contact.
std::vector<Query> queriesOf(const tools::Workload& workload);

}  // namespace radar::test
