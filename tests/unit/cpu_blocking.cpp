// Queries that ignore what they leave, skip what overlaps or list several contacts: compares the CPU's answers with
// brute force by the definition, and with the truth about solids.
#include <map>

#include "radar/cpu_sweeper.h"
#include "soups.h"
#include "voxel_truth.h"

using namespace radar;
using oracle::Rational;
using soups::Random;

namespace {

/// Checks an answer and its lists by brute force.
void check(const Scene& scene, const Query& query) {
  const Answers answers = CpuSweeper(scene, 1).run({&query, 1});
  const Listed& listed = test::listedBy(answers, 0);
  const oracle::Truth truth = oracle::truthOf(scene, query);
  const std::string fault = oracle::faultOf(truth, query, answers.results[0], listed.hits, listed.overlapping);
  INFO(fault);
  REQUIRE(fault.empty());
}

MeshId add(Scene& scene, const tools::MeshData& mesh) {
  return scene.addMesh(mesh.positions, mesh.indices);
}

/// A packing of solids, of which the first is the sensor.
struct Assembly {
  Scene scene;
  std::vector<tools::Solid> solids;
  std::vector<MeshId> meshes;
};

Assembly assembly(Random& random, uint32_t side) {
  Assembly out;
  tools::Random draw(static_cast<uint64_t>(random.integer(0, 1 << 30)));
  out.solids = tools::packedSolids(side, 2 + draw.below(3), draw);
  for (const tools::Solid& solid : out.solids) out.meshes.push_back(add(out.scene, tools::boundaryOf(solid, draw)));
  return out;
}

/// A pose that turns the axes into one another, some of them reversed, times a power of two.
Transform turnedAxes(Random& random) {
  Transform pose;
  pose.m.fill(0);
  const int first = random.integer(0, 2), step = random.integer(1, 2);
  const double scale = std::ldexp(1.0, random.integer(-2, 2));
  for (int i = 0; i < 3; ++i) {
    pose.m[4 * i + (first + step * i) % 3] = random.chance(0.5) ? scale : -scale;
    pose.m[4 * i + 3] = random.integer(-3, 3);
  }
  return pose;
}

std::array<int, 3> latticeDirection(Random& random, bool generic) {
  std::array<int, 3> d{};
  while (d == std::array<int, 3>{} || (generic && (d[0] == 0 || d[1] == 0 || d[2] == 0))) {
    for (int& c : d) c = random.integer(-2, 2);
  }
  return d;
}

std::array<double, 3> turned(const Transform& pose, const std::array<int, 3>& d) {
  std::array<double, 3> out;
  for (size_t i = 0; i < 3; ++i) out[i] = pose.m[4 * i] * d[0] + pose.m[4 * i + 1] * d[1] + pose.m[4 * i + 2] * d[2];
  return out;
}

/// The least s over all solids, or -1.
Rational truthOf(const Assembly& made, const std::array<int, 3>& direction) {
  Rational best = -1;
  for (size_t i = 1; i < made.solids.size(); ++i) {
    const Rational s = voxels::begins(made.solids[0], made.solids[i], direction);
    if (s >= 0 && (best < 0 || s < best)) best = s;
  }
  return best;
}

}  // namespace

TEST_CASE("solids that fit exactly move until their interiors would meet") {
  Random random(1);
  int blocked = 0, free = 0, later = 0;
  for (int i = 0; i < 3000; ++i) {
    INFO("case " << i);
    Assembly made = assembly(random, static_cast<uint32_t>(random.integer(2, 5)));
    const Transform pose = turnedAxes(random);
    for (size_t k = 1; k < made.meshes.size(); ++k) made.scene.addObject({made.meshes[k], pose});
    const std::array<int, 3> direction = latticeDirection(random, false);
    Query query{.mesh = made.meshes[0], .worldFromMesh = pose, .direction = turned(pose, direction), .distance = 1000};
    query.ignoreLeaving = true;
    if (random.chance(0.5)) query.slack = 0;
    const Result result = CpuSweeper(made.scene, 1).run({&query, 1}).results[0];
    const Rational truth = truthOf(made, direction);
    if (truth < 0) {
      REQUIRE(result.status == Status::clear);
      ++free;
    } else if (truth == 0) {
      REQUIRE(result.status == Status::overlap);
      ++blocked;
    } else {
      REQUIRE(result.status == Status::hit);
      const auto& d = query.direction;
      REQUIRE(result.t == Approx(truth.convert_to<double>() * std::hypot(d[0], d[1], d[2])).epsilon(1e-14));
      ++later;
    }
  }
  REQUIRE(blocked > 200);
  REQUIRE(free > 200);
  REQUIRE(later > 100);
}

TEST_CASE("solids at rest in rotated poses move as they would unrotated") {
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    INFO("case " << i);
    Assembly made = assembly(random, static_cast<uint32_t>(random.integer(2, 5)));
    const Transform pose = random.pose(std::exp(random.uniform(-5, 5)), {random.uniform(-9, 9), 0, 7});
    for (size_t k = 1; k < made.meshes.size(); ++k) made.scene.addObject({made.meshes[k], pose});
    const std::array<int, 3> direction = latticeDirection(random, true);
    Query query{.mesh = made.meshes[0], .worldFromMesh = pose, .direction = turned(pose, direction), .distance = 1e6};
    // Rounded once more, so that surfaces that touched may cross.
    for (size_t k : {3, 7, 11}) query.worldFromMesh.m[k] *= 1 + 0x1p-53 * random.integer(-1, 1);
    query.ignoreLeaving = true;
    const Result result = CpuSweeper(made.scene, 1).run({&query, 1}).results[0];
    const Rational truth = truthOf(made, direction);
    if (truth < 0) {
      REQUIRE(result.status == Status::clear);
    } else if (truth == 0) {
      REQUIRE(result.status != Status::clear);
      REQUIRE(result.t <= 1e-12);
    } else {
      const auto& d = query.direction;
      REQUIRE(result.t == Approx(truth.convert_to<double>() * std::hypot(d[0], d[1], d[2])).epsilon(1e-9));
    }
  }
}

TEST_CASE("queries that ignore what they leave equal brute force on solids and on lattice soups") {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    INFO("case " << i);
    const bool solid = random.chance(0.5);
    Assembly made = assembly(random, 2);
    if (!solid) {
      for (MeshId& mesh : made.meshes) mesh = soups::add(made.scene, soups::lattice(random, random.integer(1, 8), 2));
    }
    const auto pose = [&] { return random.chance(0.6) ? Transform() : turnedAxes(random); };
    for (size_t k = 1; k < made.meshes.size(); ++k) made.scene.addObject({made.meshes[k], pose()});
    const std::array<int, 3> d = latticeDirection(random, false);
    Query query{
        .mesh = made.meshes[0], .worldFromMesh = pose(), .direction = {double(d[0]), double(d[1]), double(d[2])}};
    query.distance = random.chance(0.2) ? 0 : random.uniform(0, 12);
    query.ignoreLeaving = random.chance(0.7);
    query.skipOverlapping = random.chance(0.5);
    query.hits = random.chance(0.3) ? 1 : random.chance(0.5) ? kAllHits : static_cast<uint32_t>(random.integer(2, 3));
    if (random.chance(0.7)) query.slack = random.chance(0.5) ? 0 : random.uniform(0, 0.5);
    check(made.scene, query);
  }
}

namespace {

const std::vector<std::array<int, 3>>& directions26() {
  static const std::vector<std::array<int, 3>> all = [] {
    std::vector<std::array<int, 3>> list;
    for (int i = 0; i < 27; ++i) {
      if (i != 13) list.push_back({i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1});
    }
    return list;
  }();
  return all;
}

}  // namespace

TEST_CASE("the blocking graph of a burr puzzle is the known one, and peeling takes the puzzle apart") {
  const std::vector<tools::Solid> pieces = tools::burrPieces();
  tools::Random random(1);
  Scene scene;
  std::vector<MeshId> meshes;
  meshes.reserve(pieces.size());
  for (const tools::Solid& piece : pieces) meshes.push_back(add(scene, tools::boundaryOf(piece, random)));
  for (const MeshId mesh : meshes) scene.addObject({mesh, Transform()});
  CpuSweeper sweeper(scene, 2);
  std::vector<ObjectId> removed;
  for (size_t key = 0; key < pieces.size(); ++key) {
    std::set<size_t> free;
    for (size_t piece = 0; piece < pieces.size(); ++piece) {
      if (std::find(removed.begin(), removed.end(), piece) != removed.end()) continue;
      for (const std::array<int, 3>& direction : directions26()) {
        Query query{.mesh = meshes[piece], .distance = 100, .exclude = removed};
        for (size_t k = 0; k < 3; ++k) query.direction[k] = direction[k];
        query.exclude.push_back(static_cast<ObjectId>(piece));
        query.ignoreLeaving = true;
        query.hits = kAllHits;
        const Answers answers = sweeper.run({&query, 1});
        if (answers.results[0].status == Status::clear) free.insert(piece);
        std::map<ObjectId, double> expected, found;
        for (ObjectId other = 0; other < pieces.size(); ++other) {
          if (std::find(query.exclude.begin(), query.exclude.end(), other) != query.exclude.end()) continue;
          const Rational s = voxels::begins(pieces[piece], pieces[other], direction);
          const double length = std::hypot(direction[0], direction[1], direction[2]);
          if (s >= 0) expected[other] = s.convert_to<double>() * length;
        }
        for (const Result& hit : answers.lists[0].hits) found[hit.object] = hit.t;
        INFO("step " << key << ", piece " << piece << ", direction " << direction[0] << direction[1] << direction[2]);
        REQUIRE(found.size() == expected.size());
        for (const auto& [object, t] : expected) REQUIRE(found.at(object) == Approx(t).epsilon(1e-14));
      }
    }
    REQUIRE(free.contains(key));
    if (key == 0) REQUIRE(free.size() < 3);
    removed.push_back(static_cast<ObjectId>(key));
  }
}
