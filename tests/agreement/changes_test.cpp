// Changes of a case that keep its first contact to the bit, since every coordinate stays exact in float.
#include <cmath>
#include <utility>

#include "agreement/compare.h"
#include "support/answer.h"
#include "support/catch.h"
#include "support/world.h"
#include "workloads/hard_cases.h"
#include "workloads/random_shapes.h"
#include "workloads/shapes.h"

namespace {

using namespace radar;
using namespace radar::tools;

constexpr double kGrid = 0x1p-8;

MeshData onGrid(MeshData mesh) {
  for (float& value : mesh.positions) value = static_cast<float>(std::round(value / kGrid) * kGrid);
  return mesh;
}

Vec3 wholeLength(Random& random) {
  constexpr std::array<Vec3, 6> kWhole{{{0, 0, 1}, {0, 3, 4}, {0, 5, 12}, {1, 2, 2}, {2, 3, 6}, {1, 4, 8}}};
  const Rotation rotation = random.quarterTurns();
  return turned(rotation, kWhole[random.below(kWhole.size())]);
}

MeshData cut(const MeshData& mesh, Random& random) {
  MeshData out{mesh.name, mesh.positions, {}};
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    const size_t k = random.below(3);
    const uint32_t a = mesh.indices[i + k], b = mesh.indices[i + (k + 1) % 3], c = mesh.indices[i + (k + 2) % 3];
    if (random.oneIn(2)) {
      out.indices.insert(out.indices.end(), {a, b, c});
      continue;
    }
    const uint32_t middle = out.vertexCount();
    for (size_t axis = 0; axis < 3; ++axis) {
      out.positions.push_back(0.5f * (out.positions[3 * b + axis] + out.positions[3 * c + axis]));
    }
    out.indices.insert(out.indices.end(), {a, b, middle, a, middle, c});
  }
  return out;
}

/// Two shapes of any kind whose coordinates, placed and moved along, are whole multiples of 2^-8 and small; directions
/// have whole components and a whole length.
HardCase dyadicCase(Random& random) {
  HardCase hard;
  const auto placed = [&](const Vec3& where) {
    MeshData mesh = onGrid(anyShape(random));
    const double size = random.oneIn(3) ? 2 : random.oneIn(2) ? 0.5 : 1;
    const Rotation rotation = random.quarterTurns();
    return PlacedMesh{std::move(mesh), makePose(rotation, {size, size, size}, where)};
  };
  hard.direction = wholeLength(random);
  const double steps = random.below(96);
  const Vec3 aside = 0.25 * random.wholeVector(6);
  const Vec3 where = (0.0625 * steps) * hard.direction + aside;
  hard.sensor = placed({});
  hard.objects.push_back(placed(where));
  hard.distance = 0.0625 * lengthOf(hard.direction) * (steps + random.below(48));
  return hard;
}

/// Turns everything by quarter turns and moves it, in the poses or in the vertices.
HardCase movedTogether(const HardCase& hard, Random& random) {
  HardCase out = hard;
  const Vec3 offset = 0.25 * random.wholeVector(1000);
  if (random.oneIn(2)) {
    place(out, random.quarterTurns(), offset);
    return out;
  }
  // In the vertices: each pose turns the offset back before, so that the world moves alike.
  const auto bakeBack = [&](PlacedMesh& placed) {
    moveVertices(placed, offset);
    moveBy(placed.worldFromMesh, offset - turned(linearPart(placed.worldFromMesh), offset));
  };
  bakeBack(out.sensor);
  for (PlacedMesh& object : out.objects) bakeBack(object);
  return out;
}

/// The object moves towards the sensor instead.
HardCase changedPlaces(const HardCase& hard) {
  HardCase out = hard;
  std::swap(out.sensor, out.objects.at(0));
  out.direction = -1 * out.direction;
  return out;
}

/// Cuts random triangles from a corner to the middle of the opposite edge.
HardCase cutInTwo(const HardCase& hard, Random& random) {
  HardCase out = hard;
  out.sensor.mesh = cut(hard.sensor.mesh, random);
  for (PlacedMesh& object : out.objects) object.mesh = cut(object.mesh, random);
  return out;
}

/// Adds objects that the sensor cannot reach.
HardCase withFarObjects(const HardCase& hard, Random& random) {
  HardCase out = hard;
  const double beyond = 1000 + 2 * hard.distance;
  for (uint32_t i = 1 + random.below(5); i > 0; --i) {
    const Vec3 where = beyond * random.direction();
    out.objects.push_back({anyShape(random), placedAt(where)});
  }
  return out;
}

/// The case, then changed in each way.
std::vector<HardCase> changesOf(const HardCase& hard, Random& random) {
  return {hard, movedTogether(hard, random), changedPlaces(hard), cutInTwo(hard, random), withFarObjects(hard, random)};
}

Result exactAnswer(const HardCase& hard) {
  const auto [scene, queries] = test::caseOf(sceneOf({hard}, Company::isolated));
  return test::answer(scene, queries[0]);
}

}  // namespace

TEST_CASE("moving, swapping, cutting and adding far objects leave the exact answer where it is, to the bit") {
  uint32_t contacts = 0;
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const HardCase hard = dyadicCase(random);
    const Result exact = exactAnswer(hard);
    contacts += exact.status != Status::clear;
    for (const HardCase& changed : changesOf(hard, random)) {
      const Result again = exactAnswer(changed);
      CHECK(again.status == exact.status);
      CHECK(again.t == exact.t);
    }
  }
  CHECK(contacts > 80);
  CHECK(contacts < 180);
}

TEST_CASE("of cases whose coordinates are exact, however changed, modes contact and sampled keep every promise") {
  std::vector<std::vector<HardCase>> changed(5);
  for (uint64_t seed = 1; seed <= kIsolatedCases; ++seed) {
    Random random(1'000'003 * seed);
    const HardCase hard = dyadicCase(random);
    const std::vector<HardCase> all = changesOf(hard, random);
    for (size_t i = 0; i < all.size(); ++i) changed[i].push_back(all[i]);
  }
  for (size_t i = 0; i < changed.size(); ++i) {
    CAPTURE(i);
    const Workload workload = sceneOf(changed[i], Company::isolated);
    Scene scene;
    replaceBy(workload, 0, scene);
    CHECK(test::compare(scene, queriesOf(workload.queries)).tally.contacts() >= 8);
    CHECK(test::compare(scene, queriesOf(workload.queries, 64), Mode::sampled).found() >= 8);
  }
}
