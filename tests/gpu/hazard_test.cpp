// The validation layer reports a missing barrier between an upload and a dispatch.
#include <cstring>

#include "gpu/barrier.h"
#include "gpu/kernel.h"
#include "gpu/submission.h"
#include "shaders/contact/interop.h"
#include "shaders/sampled/interop.h"
#include "spirv/radar_shaders.h"
#include "support/catch.h"
#include "support/test_device.h"

namespace {

using namespace radar;
using gpu::Array;
using gpu::BufferDomain;

template <class T>
Array<T> zeros(const char* name) {
  Array<T> array(test::device().impl(), name, BufferDomain::upload, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  array.reserve(1);
  std::memset(array.mapped(), 0, array.bytes());
  return array;
}

// Messages about an upload and a dispatch that reads it. All counts are zero, so the shader has nothing to do.
std::vector<std::string> messagesOf(bool withBarrier) {
  const Device::Impl& device = test::device().impl();
  gpu::Passes run(device);
  const Array<gpu::SearchCounts> counts = zeros<gpu::SearchCounts>("counts");
  const Array<gpu::SearchState> states = zeros<gpu::SearchState>("states");
  const Array<gpu::SearchTask> tasks = zeros<gpu::SearchTask>("tasks"), spilled = zeros<gpu::SearchTask>("spilled");
  const gpu::SearchTask nothing{};
  gpu::Upload upload(device);
  upload.begin();
  upload.add(&nothing, sizeof(nothing), tasks);
  gpu::Submission submission(device, false);
  const gpu::Commands commands = submission.begin();
  upload.record(commands);
  if (withBarrier) gpu::uploadToRead(commands);
  run(commands, shaders::kCollect, 1, gpu::CollectPush{0, 0, 0},
      {{gpu::kSlotCounts, counts}, {gpu::kSlotStates, states}, {gpu::kSlotTasks, tasks}, {gpu::kSlotSpilled, spilled}});
  submission.submitAndWait();
  return test::takeValidationMessages();
}

}  // namespace

TEST_CASE("a missing barrier is reported as a hazard, and with the barrier nothing is reported") {
  const std::vector<std::string> missing = messagesOf(false);
  REQUIRE_FALSE(missing.empty());
  CHECK(missing[0].find("SYNC-HAZARD") != std::string::npos);
  CHECK(messagesOf(true).empty());
}
