// Queries that ignore what they leave: compares the CPU's answers with the truth about solids.
#include <algorithm>
#include <map>

#include "soups.h"
#include "support/answer.h"
#include "support/catch.h"
#include "voxel_truth.h"

using namespace radar;
using oracle::Rational;
using soups::Random;
using test::add;
using tools::linearPart;
using tools::turned;
using tools::Vec3;

namespace {

/// A packing of solids, of which the first is the sensor.
struct Assembly {
  Scene scene;
  std::vector<tools::Solid> solids;
};

/// The others are objects in that pose.
Assembly assembly(Random& random, const Transform& pose) {
  Assembly out;
  const uint32_t side = 2 + random.below(4), count = 2 + random.below(3);
  out.solids = tools::packedSolids(side, count, random);
  for (const tools::Solid& solid : out.solids) {
    const MeshId mesh = add(out.scene, tools::boundaryOf(solid, random));
    if (mesh != 0) out.scene.addObject({mesh, pose});
  }
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

/// The least s over all solids, or -1.
Rational truthOf(const Assembly& made, const Vec3& direction) {
  Rational best = -1;
  for (size_t i = 1; i < made.solids.size(); ++i) {
    const Rational s = voxels::begins(made.solids[0], made.solids[i], direction);
    if (s >= 0 && (best < 0 || s < best)) best = s;
  }
  return best;
}

}  // namespace

TEST_CASE("solids that fit exactly move until their interiors would meet, also in poses that are rounded") {
  for (const bool rounded : {false, true}) {
    Random random(1);
    int blocked = 0, free = 0, later = 0;
    for (int i = 0; i < 2500; ++i) {
      INFO("rounded " << rounded << ", case " << i);
      const Transform pose =
          rounded ? random.pose(std::exp(random.uniform(-5, 5)), {random.uniform(-9, 9), 0, 7}) : turnedAxes(random);
      const Assembly made = assembly(random, pose);
      Vec3 direction = random.latticeVector(2);
      // Along faces, rounding decides.
      while (rounded && direction[0] * direction[1] * direction[2] == 0) direction = random.latticeVector(2);
      Query query{.mesh = 0, .worldFromMesh = pose, .direction = turned(linearPart(pose), direction), .distance = 1e6};
      query.ignoreLeaving = true;
      if (rounded) {  // once more, so that surfaces that touched may cross
        for (size_t k : {3, 7, 11}) query.worldFromMesh.m[k] *= 1 + 0x1p-53 * random.integer(-1, 1);
      } else if (random.chance(0.5)) {
        query.slack = 0;
      }
      const Result result = test::answer(made.scene, query);
      const Rational truth = truthOf(made, direction);
      (truth < 0 ? free : truth == 0 ? blocked : later) += 1;
      if (truth < 0) {
        REQUIRE(result.status == Status::clear);
      } else if (truth == 0) {
        REQUIRE(result.status != Status::clear);
        REQUIRE(result.t <= (rounded ? 1e-12 : 0));
      } else {
        const double t = truth.convert_to<double>() * tools::lengthOf(query.direction);
        REQUIRE(result.t == Approx(t).epsilon(rounded ? 1e-9 : 1e-14));
      }
    }
    CHECK(blocked > 200);
    CHECK(free > 200);
    CHECK(later > 100);
  }
}

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
      for (int i = 0; i < 27; ++i) {
        const int x = i % 3, y = i / 3 % 3, z = i / 9;
        const Vec3 direction{x - 1.0, y - 1.0, z - 1.0};
        if (direction == Vec3{}) continue;
        Query query{.mesh = meshes[piece], .direction = direction, .distance = 100, .exclude = removed};
        query.exclude.push_back(static_cast<ObjectId>(piece));
        query.ignoreLeaving = true;
        query.hits = kAllHits;
        const Answers answers = sweeper.run({&query, 1});
        if (answers.results[0].status == Status::clear) free.insert(piece);
        std::map<ObjectId, double> expected, found;
        for (ObjectId other = 0; other < pieces.size(); ++other) {
          if (std::find(query.exclude.begin(), query.exclude.end(), other) != query.exclude.end()) continue;
          const Rational s = voxels::begins(pieces[piece], pieces[other], direction);
          if (s >= 0) expected[other] = s.convert_to<double>() * tools::lengthOf(direction);
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
