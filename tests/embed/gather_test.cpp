// The device merges the searches of a query as the CPU does, however many they are.
#include "embed/gather.h"

#include "gpu/barrier.h"
#include "gpu/submission.h"
#include "query/hits.h"
#include "support/catch.h"
#include "support/same_bits.h"
#include "support/test_device.h"
#include "workloads/random.h"

namespace {

using namespace radar;

/// Searches that answer a query together.
struct Several {
  std::vector<Result> searches;
  uint32_t listed;
};

/// An answer of any kind, many of which are at the same distance.
Result randomAnswer(tools::Random& random, bool mayBeMissing, bool mayBeDecided) {
  Result result(Status::clear);
  result.object = random.below(1000);
  const double t = random.oneIn(2) ? random.uniform(0, 1) : random.below(8) / 8.0;
  if (mayBeMissing && random.oneIn(50)) {
    result.status = Status::invalid;
    result.flags = random.oneIn(2) ? Flag::candidates : Flag::range;
  } else if (random.oneIn(4)) {
    result.status = Status::undecided;
    result.lo = t;
    result.detected = random.oneIn(2) ? Detected::yes : Detected::no;
  } else if (random.oneIn(2)) {
    result.status = Status::hit;
    result.t = result.lo = result.hi = t;
    if (mayBeDecided && random.oneIn(50)) result.object = kNone;
  }
  return result;
}

/// The answers of the queries, then their lists, as the device leaves them.
std::vector<Result> gathered(const std::vector<Several>& queries) {
  std::vector<gpu::Gathered> pieces;
  uint32_t end = static_cast<uint32_t>(queries.size()), searches = 0;
  for (const Several& query : queries) {
    const auto count = static_cast<uint32_t>(query.searches.size());
    pieces.push_back({static_cast<uint32_t>(pieces.size()), searches, count, end, query.listed});
    end += query.listed;
    searches += count;
  }
  std::vector<Result> all(end);
  for (gpu::Gathered& piece : pieces) piece.first += end;
  for (const Several& query : queries) all.insert(all.end(), query.searches.begin(), query.searches.end());

  const Device::Impl& device = test::device().impl();
  GatherPass pass(device, searches);
  gpu::Array<Result> results(device, "results", gpu::BufferDomain::device,
                             VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  gpu::Buffer readback(device, "read back", gpu::BufferDomain::readback, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  gpu::Upload upload(device);
  results.reserve(all.size());
  readback.reserve(end * sizeof(Result));
  upload.begin();
  upload.add(all.data(), gpu::bytesOf(all), results);
  pass.stage(pieces);
  gpu::Submission submission(device, false);
  const gpu::Commands commands = submission.begin();
  upload.record(commands);
  pass.recordUpload(commands);
  gpu::transferToComputeReadWrite(commands);
  pass.record(commands, results, end);
  gpu::computeWriteToCopy(commands);
  const VkBufferCopy region{0, 0, end * sizeof(Result)};
  commands->CmdCopyBuffer(commands, results.get(), readback.get(), 1, &region);
  gpu::copyToHost(commands);
  submission.submitAndWait();
  const auto* first = reinterpret_cast<const Result*>(readback.mapped());
  return {first, first + end};
}

}  // namespace

TEST_CASE("the device merges the searches of a query as the CPU does") {
  tools::Random random(4);
  std::vector<Several> queries;
  for (const uint32_t count : {1u, 2u, 100u, 128u, 129u, 257u, 1000u, 5000u, 1u << 15}) {
    for (const uint32_t listed : {0u, 1u, 4u, 127u, 128u, 129u, 900u, count}) {
      if (listed > count) continue;
      const bool mayBeMissing = random.oneIn(2), mayBeDecided = random.oneIn(8);
      Several& query = queries.emplace_back();
      for (uint32_t i = 0; i < count; ++i) query.searches.push_back(randomAnswer(random, mayBeMissing, mayBeDecided));
      query.listed = listed;
    }
  }
  const std::vector<Result> found = gathered(queries);
  size_t list = queries.size(), hits = 0;
  for (size_t i = 0; i < queries.size(); ++i) {
    const auto& [searches, listed] = queries[i];
    CAPTURE(i, searches.size(), listed);
    const Merged expected = merged(searches, listed);
    CHECK(test::sameBits(found[i], expected.first));
    size_t wrong = 0;
    for (size_t k = 0; k < listed; ++k) {
      const Result& entry = found[list + k];
      const bool isEnd = k >= expected.hits.size();
      wrong += isEnd ? entry.status != Status::clear : !test::sameBits(entry, expected.hits[k]);
    }
    CHECK(wrong == 0);
    list += listed;
    hits += expected.hits.size();
  }
  CHECK(hits > 20'000);
}
