// The validation layer must see what it is there for: a missing barrier between an upload and a dispatch.
#include <catch2/catch.hpp>
#include <map>

#include "gpu/barrier.h"
#include "gpu/buffer.h"
#include "gpu/pipeline.h"
#include "gpu/submission.h"
#include "shaders/interop.h"
#include "spirv/solve_comp_RADAR_NO_DOUBLES.h"
#include "support/test_device.h"

namespace {

using namespace radar;

// An upload, then a dispatch that reads what was uploaded (and, of all zeros, finds nothing to do).
std::vector<std::string> messagesOf(bool withBarrier) {
  const Device::Impl& device = test::device().impl();
  std::vector<gpu::Binding> list;
  for (uint32_t i = 0; i < gpu::kBindings; ++i) {
    if (i != gpu::kBindRange && i != gpu::kBindMask) list.push_back({i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  }
  gpu::Bindings bindings(device, list, 8);
  const gpu::Pipeline solve = gpu::computePipeline(device, bindings.layout(), k_solve_comp_RADAR_NO_DOUBLES, "solve");
  std::map<uint32_t, gpu::Buffer> buffers;
  for (const gpu::Binding& binding : list) {
    gpu::Buffer& buffer = buffers
                              .try_emplace(binding.number, device, "hazard", gpu::Residence::upload,
                                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT)
                              .first->second;
    std::fill_n(buffer.mapped(), 1024, std::byte{0});
    bindings.setBuffer(binding.number, buffer);
  }
  const gpu::View nothing{};
  gpu::Upload upload(device);
  upload.begin(sizeof(nothing));
  upload.add(&nothing, sizeof(nothing), buffers.at(gpu::kBindViews));
  gpu::Submission submission(device, false);
  const gpu::Commands commands = submission.begin();
  commands->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, solve.get());
  bindings.bind(commands);
  upload.record(commands);
  if (withBarrier) gpu::uploadToRead(commands);
  commands->CmdDispatch(commands, 1, 1, 1);
  submission.submitAndWait();
  return test::takeValidationMessages();
}

}  // namespace

TEST_CASE("a missing barrier is reported as a hazard, and the barrier silences it") {
  const std::vector<std::string> missing = messagesOf(false);
  REQUIRE_FALSE(missing.empty());
  CHECK(missing[0].find("SYNC-HAZARD") != std::string::npos);
  CHECK(messagesOf(true).empty());
}
