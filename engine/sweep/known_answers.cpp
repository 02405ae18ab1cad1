#include "sweep/known_answers.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "radar/cpu_sweeper.h"
#include "scene/scene.h"
#include "sweep/difference.h"
#include "sweep/sweeper.h"

namespace radar {

namespace {

// SplitMix64: the same numbers everywhere.
class Numbers {
 public:
  explicit Numbers(uint64_t seed) : state_(seed) {}
  uint64_t bits() {
    uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  uint32_t below(uint32_t n) { return static_cast<uint32_t>(bits() % n); }
  double uniform(double lo, double hi) { return lo + (hi - lo) * static_cast<double>(bits() >> 11) * 0x1p-53; }
  float near(double x, double off) { return static_cast<float>(x + uniform(-off, off)); }

 private:
  uint64_t state_;
};

struct Shape {
  std::vector<float> positions;
  std::vector<uint32_t> indices;
};

Shape box() {
  Shape shape;
  for (int i = 0; i < 8; ++i) {
    for (int k = 0; k < 3; ++k) shape.positions.push_back((i >> k & 1) != 0 ? 1.0f : -1.0f);
  }
  shape.indices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                   2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  return shape;
}

// Two tips and a ring around them.
Shape jagged(Numbers& numbers) {
  constexpr uint32_t kRing = 7;
  Shape shape{{numbers.near(0, 0.2), numbers.near(0, 0.2), -1.5f, numbers.near(0, 0.2), numbers.near(0, 0.2), 1.5f},
              {}};
  for (uint32_t i = 0; i < kRing; ++i) {
    const double x = std::array{1.0, 0.6, -0.2, -0.9, -0.9, -0.2, 0.6}[i],
                 y = std::array{0.0, 0.8, 1.0, 0.4, -0.4, -1.0, -0.8}[i];
    shape.positions.insert(shape.positions.end(), {numbers.near(x, 0.3), numbers.near(y, 0.3), numbers.near(0, 0.3)});
    const uint32_t p = 2 + i, q = 2 + (i + 1) % kRing;
    for (const uint32_t corner : {0u, q, p, 1u, p, q}) shape.indices.push_back(corner);
  }
  return shape;
}

Shape needles(Numbers& numbers) {
  Shape shape;
  for (uint32_t i = 0; i < 9; ++i) {
    const double along = i % 3 == 0 ? -3 : 3;
    shape.positions.insert(shape.positions.end(),
                           {numbers.near(along, 0.5), numbers.near(0, 0.02), numbers.near(0, 0.02)});
    shape.indices.push_back(i);
  }
  return shape;
}

Shape sheet(Numbers& numbers) {
  constexpr uint32_t kSide = 5;
  Shape shape;
  for (uint32_t i = 0; i < kSide * kSide; ++i) {
    const uint32_t column = i % kSide, row = i / kSide;
    shape.positions.insert(shape.positions.end(),
                           {static_cast<float>(column) - 2, static_cast<float>(row) - 2, numbers.near(0, 0.2)});
    if (column == kSide - 1 || row == kSide - 1) continue;
    for (const uint32_t corner : {i, i + 1, i + kSide, i + 1, i + kSide + 1, i + kSide})
      shape.indices.push_back(corner);
  }
  return shape;
}

// Of floats. The origin of the mesh's vertices goes near `at`.
Transform poseAt(Numbers& numbers, const Vector& at, const Vector& origin, bool isTurned) {
  Transform pose;
  do {
    for (size_t i = 0; i < 12 && isTurned; ++i) pose.m[i] = numbers.near(0, 1);
  } while (std::abs(determinant(pose)) < 0.1);
  for (size_t row = 0; row < 3; ++row) {
    double place = at[row];
    for (size_t k = 0; k < 3; ++k) place -= pose.m[4 * row + k] * origin[k];
    pose.m[4 * row + 3] = static_cast<float>(place);
  }
  return pose;
}

}  // namespace

KnownScene::KnownScene(uint64_t seed) {
  Numbers numbers(seed);
  constexpr size_t kShapes = 4;
  const Vector origins[kShapes] = {{0, 0, 0}, {300.7, -50.1, 7.3}, {-1, 2, 20.5}, {-90.25, 0, 11}};
  const Shape shapes[kShapes] = {box(), jagged(numbers), needles(numbers), sheet(numbers)};
  for (size_t i = 0; i < kShapes; ++i) {
    std::vector<float> positions = shapes[i].positions;
    for (size_t k = 0; k < positions.size(); ++k) positions[k] += static_cast<float>(origins[i][k % 3]);
    meshes.push_back(scene.addMesh(positions, shapes[i].indices));
  }
  const Vector centre = seed % 2 == 0 ? Vector{} : Vector{65536.12345678895, -8192.3, 301.7};
  std::vector<Vector> places;
  const auto place = [&](double spread, size_t& shape, bool& isTurned) {
    shape = numbers.below(kShapes);
    isTurned = shape != 0 || numbers.below(2) == 0;
    Vector at = centre;
    for (double& x : at)
      x += isTurned ? numbers.uniform(-spread, spread) : std::floor(numbers.uniform(-spread, spread));
    return at;
  };
  size_t shape = 0;
  bool isTurned = false;
  for (uint32_t i = 0; i < 32; ++i) {
    places.push_back(place(8, shape, isTurned));
    scene.addObject({.mesh = meshes[shape],
                     .worldFromMesh = poseAt(numbers, places.back(), origins[shape], isTurned),
                     .mask = numbers.below(8) == 0 ? 2u : 3u});
  }
  for (uint32_t i = 0; i < 24; ++i) {
    const Vector at = place(10, shape, isTurned), &to = places[numbers.below(32)];
    Query query{.mesh = meshes[shape], .worldFromMesh = poseAt(numbers, at, origins[shape], isTurned)};
    for (size_t k = 0; k < 3; ++k) query.direction[k] = static_cast<float>(to[k] - at[k]);
    if (i % 4 == 0 || query.direction == Vector{}) query.direction = {0, i % 8 == 0 ? 1.0 : 0.0, -1};
    query.distance = static_cast<float>(numbers.uniform(2, 20));
    query.anyHit = i % 8 == 3;
    query.ignoreLeaving = i % 4 == 2;
    if (i % 8 == 2) query.slack = 0x1p-20;
    query.mask = i % 5 == 0 ? 1 : ~0u;
    if (i % 3 == 0) query.exclude = {numbers.below(32)};
    queries.push_back(query);
  }
}

AnswerCheck orAllWrong(const char* kind, size_t asked, const std::function<AnswerCheck()>& check) {
  try {
    return check();
  } catch (const Error& error) {
    if (error.kind != Error::Kind::internal) throw;
    const auto all = static_cast<uint32_t>(asked);
    return {
        .kind = kind, .asked = all, .wrong = all, .stage = nameOf(Stage::searching, false), .firstWrong = error.what()};
  }
}

AnswerCheck compared(const char* kind, std::vector<Result> found, std::span<const Result> exact, bool places) {
  found.resize(exact.size());
  AnswerCheck check{.kind = kind, .asked = static_cast<uint32_t>(exact.size())};
  Stage first = Stage::none;
  for (size_t i = 0; i < exact.size(); ++i) {
    const auto [stage, numbers] = differenceOf(found[i], exact[i]);
    if (stage == Stage::none) continue;
    if (check.wrong == 0) check.firstWrong = "answer " + std::to_string(i) + ": " + numbers;
    ++check.wrong;
    first = std::max(first, stage);
  }
  check.stage = nameOf(first, places);
  return check;
}

namespace {

// The answers, then what they list.
std::vector<Result> all(Answers answers) {
  for (const Listed& listed : answers.lists) {
    answers.results.insert(answers.results.end(), listed.hits.begin(), listed.hits.end());
  }
  return std::move(answers.results);
}

Answers answersOf(const Device::Impl& device, const Scene& scene, std::span<const Query> queries, Mode mode) {
  Sweeper::Impl sweeper(device, scene, {.cpuBatch = 0}, std::make_shared<GpuScene>(device), {}, false);
  Flight flight(queries, false);
  sweeper.begin(flight, mode);
  sweeper.finish(flight);
  if (flight.failure) throw Error(*flight.failure);
  return std::move(flight.answers);
}

AnswerCheck check(const char* kind, const Device::Impl& device, const KnownScene& known,
                  std::span<const Query> queries) {
  return orAllWrong(kind, queries.size(), [&] {
    Answers found = answersOf(device, known.scene, queries, Mode::contact);
    const uint64_t onCpu = found.stats.cpuQueries;
    AnswerCheck check = compared(kind, all(std::move(found)), all(CpuSweeper(known.scene).run(queries)));
    // But for clearances, where the device may well leave queries open.
    if (onCpu > 0 && queries[0].clearance == 0) {
      check.wrong += static_cast<uint32_t>(onCpu);
      if (check.stage.empty()) check.stage = nameOf(Stage::solving, false);
      check.firstWrong +=
          (check.firstWrong.empty() ? "" : "; ") + std::to_string(onCpu) + " queries were left to the CPU";
    }
    return check;
  });
}

struct SearchProof {
  explicit SearchProof(const Device::Impl& device) {
    for (uint64_t seed = 0; seed < kProofs; ++seed) {
      const std::vector<AnswerCheck> some = checkSweeper(device, seed, false);
      checks.insert(checks.end(), some.begin(), some.end());
    }
  }
  std::vector<AnswerCheck> checks;
};

}  // namespace

std::vector<AnswerCheck> checkSweeper(const Device::Impl& device, uint64_t seed, bool clearances) {
  KnownScene known(seed);
  std::vector<AnswerCheck> checks{check("first contacts", device, known, known.queries)};
  std::vector<Query> queries = known.queries;
  for (Query& query : queries) {
    if (!query.anyHit) query.hits = query.mask == 1 ? kAllHits : 3;
  }
  checks.push_back(check("lists", device, known, queries));
  if (clearances) {
    queries = known.queries;
    std::erase_if(queries, [](const Query& query) { return query.ignoreLeaving; });
    for (Query& query : queries) query.clearance = 0.125;
    checks.push_back(check("clearances", device, known, queries));
  }
  queries = known.queries;
  for (Query& query : queries) query.motion = std::exchange(query.direction, {}), query.distance = 0;
  for (ObjectId id = 0; id < 32; id += 3) known.scene.setMotion(id, {0.5, -1, 0.25});
  checks.push_back(check("steps", device, known, queries));
  return checks;
}

AnswerCheck checkSampled(const Device::Impl& device, uint64_t seed) {
  const KnownScene known(seed);
  std::vector<Query> queries = known.queries;
  for (Query& query : queries) {
    query.anyHit = query.ignoreLeaving = false;
    query.slack.reset();
  }
  const std::vector<Result> exact = CpuSweeper(known.scene).run(queries).results;
  std::vector<Result> found = answersOf(device, known.scene, queries, Mode::sampled).results;
  // Right answers are replaced by the exact ones, with which they are then compared.
  for (size_t i = 0; i < queries.size(); ++i) {
    const bool holds = found[i].flags == 0 && found[i].status != Status::invalid && found[i].lo <= exact[i].hi &&
                       exact[i].lo <= found[i].hi;
    if (holds && (found[i].status == Status::undecided ||
                  (found[i].status == Status::clear) == (exact[i].status == Status::clear))) {
      found[i] = exact[i];
    }
  }
  AnswerCheck check = compared("mode sampled", found, exact);
  if (!check.passed()) check.stage = "drawing or solving";
  return check;
}

void requirePassed(const Device::Impl& device, std::span<const AnswerCheck> checks) {
  std::vector<std::string> reasons;
  for (const AnswerCheck& check : checks) {
    if (check.passed()) continue;
    reasons.push_back(check.kind + ": " + std::to_string(check.wrong) + " of " + std::to_string(check.asked) +
                      " answers differ from the CPU's, in " + check.stage + "; " + check.firstWrong);
  }
  if (!reasons.empty()) {
    throw Error(
        device.name + " (" + device.driver + ") cannot be used: its answers to known queries differ from the CPU's",
        VK_SUCCESS, reasons);
  }
}

void requireProof(const Device::Impl& device) {
  requirePassed(device, device.shared<SearchProof>().checks);
}

}  // namespace radar
