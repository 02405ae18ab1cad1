#include "embed/renderer.h"

#include <cmath>

#include "embed/host_barrier.h"
#include "spirv/read_results_comp.h"
#include "spirv/read_results_comp_RADAR_NO_DOUBLES.h"
#include "support/catch.h"
#include "workloads/shapes.h"

namespace radar::test {

Renderer::Renderer(const Device& device)
    : device_(device.impl()),
      submission_(device_, false),
      bindings_(device_, 2, sizeof(uint32_t)),
      pipeline_(gpu::computePipeline(device_, bindings_.layout(),
                                     device.handles().doubles ? std::span<const uint32_t>(k_read_results_comp)
                                                              : k_read_results_comp_RADAR_NO_DOUBLES,
                                     "host's pass")),
      shaderResults_(device_, "shader results", gpu::BufferDomain::readback, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT) {
  shaderResults_.reserve(4096 * sizeof(ShaderResult));
  bindings_.setBuffer(1, shaderResults_.get());
}

void Renderer::record(Recorder& recorder, std::span<const Query> queries, bool withBarrier) {
  const gpu::Commands commands = submission_.begin();
  recorder.record(commands, queries);
  if (withBarrier) barrier(commands, Recorder::kWrites, kShaderReads);
  bindings_.setBuffer(0, recorder.results());
  const auto count = static_cast<uint32_t>(queries.size());
  commands->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
  bindings_.bind(commands);
  commands->CmdPushConstants(commands, bindings_.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(count), &count);
  commands->CmdDispatch(commands, (count + 63) / 64, 1, 1);
}

bool checkShaderResult(const Renderer::ShaderResult& found, const Result& expected) {
  if (found.flags == Flag::unresolved) {
    const bool isHit = found.status == static_cast<uint32_t>(Status::hit);
    CHECK((isHit ? expected.status == Status::hit : found.status == static_cast<uint32_t>(Status::undecided)));
    CHECK_FALSE(found.t > expected.t);
    CHECK((found.free >= 0 && double{found.free} <= std::min(expected.hi, 3.0)));
    return true;
  }
  CHECK(found.flags == 0);
  CHECK(found.status == static_cast<uint32_t>(expected.status));
  CHECK(found.object == expected.object);
  // The nearest float that is not above.
  const double free = expected.status == Status::invalid ? 0.0 : std::min(expected.lo, 3.0);
  CHECK(double{found.free} <= free);
  CHECK(double{std::nextafter(found.free, 4.0f)} > free);
  if (!std::isfinite(expected.t)) {
    CHECK(std::isinf(found.t) == std::isinf(expected.t));
  } else {
    CHECK(std::abs(found.t) <= std::abs(expected.t));
    CHECK(found.t == Approx(expected.t).epsilon(3e-7).margin(1e-37));
  }
  return false;
}

Row::Row(uint32_t sensors) {
  const tools::MeshData box = tools::makeBox({1, 1, 1});
  mesh = scene.addMesh(box.positions, box.indices);
  for (uint32_t i = 0; i < 8; ++i) {
    scene.addObject({mesh, {{1, 0, 0, 1.1 * i, 0, 1, 0, 0.2, 0, 0, 1, 4.0 + i}}, ~0u});
  }
  for (uint32_t i = 0; i < sensors; ++i) {
    const Transform pose{{0.9, 0.1, 0.2, 0.7 * i - 1.2, -0.1, 0.9, 0.3, 0.1, -0.2, -0.3, 0.9, 0.01 * i}};
    queries.push_back({.mesh = mesh, .worldFromMesh = pose, .direction = {0, 0.01, 1}, .distance = 20});
  }
}

std::vector<Query> queriesOf(const tools::Workload& workload) {
  return tools::queriesOf(workload.queries);
}

}  // namespace radar::test
