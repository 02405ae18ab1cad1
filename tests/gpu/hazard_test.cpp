// The validation layers report a missing barrier, so that the other tests may rely on their silence.
#include "gpu/kernel_fixture.h"
#include "support/catch.h"

namespace {

using namespace radar;
using namespace radar::test;
using gpu::Array;
using gpu::BufferDomain;
using gpu::Commands;
using Record = std::function<void(const Commands&)>;

// Checks two commands with and without a barrier between them, recorded but never submitted.
void check(const char* what, const Record& before, const Record& barrier, const Record& after) {
  CAPTURE(what);
  for (const bool withBarrier : {false, true}) {
    {
      gpu::Submission submission(impl(), false);
      const Commands commands = submission.begin();
      before(commands);
      if (withBarrier) barrier(commands);
      after(commands);
    }
    const std::vector<std::string> messages = takeValidationMessages();
    const bool isExpected = !withBarrier && isValidated();
    CHECK(messages.empty() != isExpected);
    if (isExpected) CHECK_THAT(messages.at(0), test::Contains("SYNC-HAZARD-READ-AFTER-WRITE"));
  }
}

}  // namespace

TEST_CASE("a missing barrier is reported as a hazard, and with the barrier nothing is reported") {
  gpu::Passes passes(impl());
  Array<uint32_t> values(impl(), "values", BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  Array<Node> nodes(impl(), "nodes", BufferDomain::device, gpu::kAsTexels);
  Array<Groups> groups(impl(), "groups", BufferDomain::device, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
  values.reserve(1);
  nodes.reserve(1);
  groups.reserve(1);
  const Array<uint32_t> results = numbers("results", 1);
  gpu::Upload upload(impl());
  const uint32_t one = 1;
  upload.begin();
  upload.add(&one, sizeof one, values);
  const auto scale = [&](const Commands& commands) {
    passes(commands, kScaleOf64, 1, ScalePush{1, 1}, {{kSlotValues, values}, {kSlotResults, results}});
  };
  check(
      "an upload and a dispatch", [&](const Commands& commands) { upload.record(commands); }, gpu::uploadToRead, scale);
  check(
      "a dispatch and one whose workgroups it counts",
      [&](const Commands& commands) {
        passes(commands, kCountGroups, 1, 1u, {{kSlotGroups, groups}});
      },
      gpu::computeWriteToIndirect,
      [&](const Commands& commands) {
        passes(commands, kScaleOf64, {groups, 0}, ScalePush{1, 1}, {{kSlotValues, values}, {kSlotResults, results}});
      });
  check(
      "a dispatch and one that reads texels",
      [&](const Commands& commands) {
        passes(commands, kFillNodes, 1, 1u, {{kSlotNodes, nodes}});
      },
      gpu::computeWriteToComputeReadWrite,
      [&](const Commands& commands) {
        passes(commands, kSumTexels, 1, {{kSlotNodes, nodes}, {kSlotResults, results}});
      });
}
