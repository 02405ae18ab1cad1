// Fuzzes a Sweeper and a Recorder that share a scene's copy: an input is a capacity and a sequence of edits of a scene,
// of batches and of recordings, in some of which a host deforms meshes. Each answer is the CPU's, or its flag says
// which limit was too small; with the capacity that needed() gives, all are answered.
#include <cmath>

#include "embed/host_frame.h"
#include "fuzz/check_answers.h"
#include "fuzz/check_recorded.h"
#include "fuzz/scene_calls.h"
#include "fuzz/target.h"
#include "radar/cpu_sweeper.h"
#include "radar/radar.h"
#include "scene/scene.h"
#include "support/scene_model.h"
#include "support/test_device.h"

namespace radar::fuzz {

namespace {

Capacity capacityFrom(Choices& choices) {
  if (choices.oneIn(16)) {
    return {.queries = choices.of(std::array{1u, ~0u}),
            .candidates = choices.of(std::array{1u, 1u << 31}),
            .rounds = choices.of(std::array{0u, 1u, 2u, 3u, 66u, ~0u}),
            .unresolvedPairs = choices.of(std::array{1u, ~0u}),
            .searches = choices.of(std::array{0u, ~0u})};
  }
  return {.queries = choices.of(std::array{0u, 2u, 3u, 4u, 8u}),
          .candidates = choices.of(std::array{0u, 1u, 3u, 16u, 100u, 1000u}),
          .rounds = choices.of(std::array{2u, 2u, 4u, 16u, 64u}),
          .unresolvedPairs = choices.of(std::array{0u, 1u, 2u, 20u, 200u}),
          .searches = choices.of(std::array{0u, 8u, 64u})};
}

bool isValid(const Capacity& capacity) {
  constexpr uint32_t kMost = 1u << 16;  // of what is chosen above
  return std::max({capacity.queries, capacity.candidates, capacity.unresolvedPairs, capacity.searches}) < kMost &&
         capacity.rounds <= 64 && capacity.rounds % 2 == 0;
}

/// The queries that can be recorded, after those that cannot have been refused.
std::vector<Query> recordable(SceneCalls& calls, Recorder& recorder, const Capacity& capacity) {
  std::vector<Query> queries = calls.queries(4);
  const auto isInvalid = [&](const Query& query) {
    return !validate(query, calls.scene()).empty() || !test::isRecordable(query, calls.scene());
  };
  const auto record = [&](const auto& all) { test::execute(test::device(), recorder, all); };
  leaveValid(queries, isInvalid, record);
  if (queries.size() > capacity.queries) {
    requireRefused([&] { record(queries); });
    queries.resize(capacity.queries);
  }
  return queries;
}

/// Vertices that a host deforms, and the scene as it then is.
struct Deformation {
  Deformation(Choices& choices, const Scene& scene) : truth(test::SceneModel::of(scene).build()) {
    for (MeshId id = 0; id < scene.meshLimit(); ++id) {
      if (!scene.hasMesh(id) || scene.impl().meshes[id].hasBounds || !choices.oneIn(2)) continue;
      std::vector<float> positions(scene.mesh(id).positions.begin(), scene.mesh(id).positions.end());
      const bool isWild = choices.oneIn(4);
      for (float& x : positions) {
        if (choices.oneIn(2)) x = choices.number<float>(isWild);
        if (!(std::abs(x) < 0x1p120f)) isFinite = false;
      }
      if (isFinite) truth.setPositions(id, positions);
      frame.deform(id, positions);
    }
  }
  /// Whether nothing has bounds that it may leave, and floats hold all numbers with room to spare.
  bool isOrdinary(const Scene& scene) const {
    const auto isSmall = [](double x) { return std::abs(x) < 0x1p30; };
    if (!scene.impl().bounds.empty()) return false;
    for (ObjectId id = 0; id < truth.objectLimit(); ++id) {
      if (!truth.hasObject(id)) continue;
      const Object& object = truth.object(id);
      if (!std::ranges::all_of(object.worldFromMesh.m, isSmall)) return false;
      if (!std::ranges::all_of(truth.mesh(object.mesh).positions, isSmall)) return false;
    }
    return isFinite;
  }
  Scene truth;
  bool isFinite = true;
  test::HostFrame frame;
};

/// Compares a recording with the CPU's answers; if capacities were too small, records again with larger ones.
void compare(const SceneCalls& calls, Recorder& recorder, const std::vector<Query>& queries, const Answers& expected,
             const HostGeometry& geometry = {}) {
  Answers recorded = test::execute(test::device(), recorder, queries, geometry);
  checkRecorded(queries, recorded, expected);
  Capacity enough = enoughFor(recorder);
  for (int i = 0; i < 10 && isTooSmall(recorded); ++i) {
    Recorder larger(test::device(), calls.scene(), enough);
    recorded = test::execute(test::device(), larger, queries, geometry);
    checkRecorded(queries, recorded, expected);
    enough = enoughFor(larger);
    require(enough.rounds % 2 == 0, "an odd number of rounds");
  }
  require(!isTooSmall(recorded), "what needed() gives is not enough");
}

void ask(SceneCalls& calls, Recorder& recorder, const Capacity& capacity) {
  const std::vector<Query> queries = recordable(calls, recorder, capacity);
  compare(calls, recorder, queries, CpuSweeper(calls.scene(), 1).run(queries));
}

void deform(Choices& choices, SceneCalls& calls, Recorder& recorder, const Capacity& capacity) {
  const std::vector<Query> queries = recordable(calls, recorder, capacity);
  Deformation deformed(choices, calls.scene());
  const HostGeometry geometry = deformed.frame.geometry();
  const Answers recorded = test::execute(test::device(), recorder, queries, geometry);
  const auto isRefused = [](const Result& result) { return (result.flags & Flag::bounds) != 0; };
  if (std::ranges::any_of(recorded.results, isRefused)) {
    require(std::ranges::all_of(recorded.results, isRefused), "some answers are refused and others not");
    require(!recorder.boundsViolation().empty(), "nobody says what left its bounds");
    return require(!deformed.isOrdinary(calls.scene()), "refused: " + recorder.boundsViolation());
  }
  require(deformed.isFinite || queries.empty(), "vertices that are not finite are searched");
  if (deformed.isFinite) compare(calls, recorder, queries, CpuSweeper(deformed.truth, 1).run(queries), geometry);
}

void sweep(Choices& choices, SceneCalls& calls, Sweeper& sweeper) {
  const Mode mode = choices.oneIn(3) ? Mode::sampled : Mode::contact;
  std::vector<Query> queries = calls.queries(4);
  const auto isInvalid = [&](const Query& query) { return !validate(query, calls.scene(), mode).empty(); };
  leaveValid(queries, isInvalid, [&](const auto& all) { sweeper.run(all, mode); });
  const Answers found = sweeper.run(queries, mode);
  Answers expected = CpuSweeper(calls.scene(), 1).run(queries);
  for (size_t i = 0; mode == Mode::sampled && i < queries.size(); ++i) {
    checkSampled(found.results[i], expected.results[i], test::reasonFor(found, i));
    expected.results[i] = found.results[i];
  }
  requireSame(found, expected);
}

void run(std::string_view input) {
  Choices choices(input);
  const Capacity capacity = capacityFrom(choices);
  SceneCalls calls(choices);
  SceneCopy copy(test::device(), calls.scene());
  Sweeper sweeper(copy, {.cpuBatch = choices.below(3)});
  std::optional<Recorder> recorder;
  const auto make = [&] { recorder.emplace(copy, capacity); };
  if (!isValid(capacity)) return requireRefused(make);
  make();
  const bool isChosen = capacity.candidates == 0;
  require(isChosen || recorder->needed().candidates == capacity.candidates, "nothing recorded, but more needed");
  for (int i = 0; i < 60 && !choices.areOver(); ++i) {
    try {
      if (choices.oneIn(4)) {
        ask(calls, *recorder, capacity);
      } else if (choices.oneIn(4)) {
        sweep(choices, calls, sweeper);
      } else if (choices.oneIn(8)) {
        deform(choices, calls, *recorder, capacity);
      } else {
        calls.edit();
      }
    } catch (const Error& error) {
      require(std::string_view(error.what()).find("Capacity::searches") != std::string_view::npos, error.what());
    }
  }
  for (const std::string& message : test::takeValidationMessages()) require(false, "validation: " + message);
}

}  // namespace

const Target& target() {
  static const Target kTarget{run, [] { return randomSeeds(64, 500); }, {}};
  return kTarget;
}

}  // namespace radar::fuzz
