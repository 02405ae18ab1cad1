// A host's shader writes queries and their number in the command buffer that answers them.
#include <numeric>

#include "embed/checks.h"
#include "embed/host_barrier.h"
#include "embed/quiet_frames.h"
#include "embed/renderer.h"
#include "embed/written_queries.h"
#include "spirv/write_queries_comp.h"

namespace {

using namespace radar;

struct WritePush {
  uint32_t number;
  float height;
};

/// The query that write_queries.comp writes.
HostQuery queryOfShader(uint32_t i, float height) {
  return {.worldFromMesh = {0.5f, 0, 0, 0.25f * static_cast<float>(i), 0, 0.5f, 0.125f, 0, 0, -0.125f, 0.5f, height},
          .direction = {0, 0.015625f * static_cast<float>(i % 4), 1},
          .distance = 20,
          .mesh = 0,
          .mask = ~0u,
          .exclude = i % 2 == 0 ? kNone : i % 8,
          .flags = i % 5 == 4 ? HostQuery::kAnyHit : 0};
}

/// A host's shader that asks, with its buffers.
class Asker {
 public:
  explicit Asker(const Device& device)
      : impl_(device.impl()),
        queries_(impl_, "asked", gpu::BufferDomain::device, kUsage),
        number_(impl_, "number", gpu::BufferDomain::device, kUsage),
        bindings_(impl_, 2, sizeof(WritePush)),
        pipeline_(gpu::computePipeline(impl_, bindings_.layout(), k_write_queries_comp, "ask")),
        submission_(impl_, false) {
    queries_.reserve(256 * sizeof(HostQuery));
    number_.reserve(4);
    bindings_.setBuffer(0, queries_.get());
    bindings_.setBuffer(1, number_.get());
  }

  std::vector<Result> ask(Recorder& recorder, const WritePush& push, bool withBarrier = true) {
    const gpu::Commands commands = submission_.begin();
    bindings_.bind(commands);
    commands->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
    commands->CmdPushConstants(commands, bindings_.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(push), &push);
    commands->CmdDispatch(commands, 4, 1, 1);
    if (withBarrier) test::barrier(commands, Recorder::kWrites, Recorder::kReads);
    recorder.record(commands, HostQueries{.buffer = queries_.get(), .count = 256, .countBuffer = number_.get()});
    submission_.submitAndWait();
    return recorder.read().results;
  }

 private:
  static constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | kHostBufferUsage;
  const Device::Impl& impl_;
  gpu::Buffer queries_, number_;
  test::Bindings bindings_;
  gpu::Pipeline pipeline_;
  gpu::Submission submission_;
};

/// Frames in which that shader asks, never the same.
struct AskingFrames {
  AskingFrames(const Device& engine, const Device& hosts)
      : asker(hosts),
        recorder(engine, row.scene, {.queries = 256, .candidates = 1u << 16, .unresolvedPairs = 1u << 14}) {}
  ~AskingFrames() {
    CHECK(hits > 500);
    CHECK(clear > 500);
  }
  void operator()(uint32_t frame) {
    const WritePush push{std::array{40u, 0u, 1u, 256u, 64u, 65u}[frame % 6], static_cast<float>(frame) / 64};
    const std::vector<Result> read = asker.ask(recorder, push);
    std::vector<Query> queries;
    for (uint32_t i = 0; i < push.number; ++i) queries.push_back(test::queryOf(queryOfShader(i, push.height)));
    test::checkSame(read, test::expectedOf(row.scene, queries));
    hits += std::ranges::count(read, Status::hit, &Result::status);
    clear += std::ranges::count(read, Status::clear, &Result::status);
  }
  test::Row row{1};
  Asker asker;
  Recorder recorder;
  ptrdiff_t hits = 0, clear = 0;
};

}  // namespace

TEST_CASE(
    "frames in which a shader writes queries and their number are answered, and allocate, submit and wait for "
    "nothing") {
  test::checkQuiet<AskingFrames>(60, 2);
}

TEST_CASE("of queries that a shader writes, only those that count are counted, and needed() tells what would do") {
  const test::Row row(1);
  Recorder recorder(test::device(), row.scene, {.queries = 256});
  Asker asker(test::device());
  const std::vector<Result> expected = asker.ask(recorder, {.number = 100, .height = -3});
  REQUIRE(expected.size() == 100);
  const AnswerCounts counted = recorder.answerCounts();
  CHECK(std::accumulate(counted.byStatus.begin(), counted.byStatus.end(), 0u) == 100);
  CHECK(counted.of(Status::invalid) == 0);
  CHECK(counted.of(Status::clear) == std::ranges::count(expected, Status::clear, &Result::status));
  CHECK(counted.of(Status::clear) > 0);
  CHECK(counted.of(Status::hit) + counted.of(Status::undecided) > 0);
  const Capacity needed = recorder.needed();
  CHECK(needed.searches == 0);
  CHECK(needed.candidates < 100 * 100);
  Recorder again(test::device(), row.scene, needed);
  test::checkSame(asker.ask(again, {.number = 100, .height = -3}), expected);
}

TEST_CASE("a shader that writes queries without the documented barrier causes a hazard") {
  test::Row row(1);
  Asker asker(test::device());
  Recorder recorder(test::device(), row.scene, {.queries = 256});
  for (const bool withBarrier : {true, false, true}) {
    asker.ask(recorder, {40, 0}, withBarrier);
    test::checkHazard(!withBarrier);
  }
}
