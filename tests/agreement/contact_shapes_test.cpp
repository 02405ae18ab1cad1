// The search on the device against the CPU's where shapes interlock, touch, slide and tie.
#include <catch2/catch.hpp>
#include <cmath>

#include "agreement/compare.h"
#include "support/test_device.h"
#include "workloads/generate.h"

namespace {

using namespace radar;
using test::compareContact;
using test::ContactTally;
using tools::MeshData;
using tools::Random;
using tools::Vec3;

constexpr std::array<double, 9> kUpright{1, 0, 0, 0, 1, 0, 0, 0, 1};
constexpr Vec3 kFull{1, 1, 1};

MeshId add(Scene& scene, const MeshData& mesh) {
  return scene.addMesh(mesh.positions, mesh.indices);
}

Transform at(const Vec3& place, const Vec3& scale = kFull) {
  return tools::makePose(kUpright, scale, place);
}

/// About a random axis by up to `angle` or so.
std::array<double, 9> smallRotation(Random& random, double angle) {
  const double half = 0.5 * angle;
  Vec3 v = random.inBox({-half, -half, -half}, {half, half, half});
  const double norm = std::sqrt(1 + v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  const double w = 1 / norm, x = v[0] / norm, y = v[1] / norm, z = v[2] / norm;
  return {1 - 2 * (y * y + z * z), 2 * (x * y - z * w),     2 * (x * z + y * w),
          2 * (x * y + z * w),     1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
          2 * (x * z - y * w),     2 * (y * z + x * w),     1 - 2 * (x * x + y * y)};
}

/// Narrower teeth than makeComb's, hanging down: fits between them.
MeshData looseComb() {
  MeshData mesh = tools::makeBox({3, 0.3, 0.3});
  for (double x : {-1.0, 0.0, 1.0}) tools::append(mesh, tools::makeBox({0.3, 0.3, 1.5}), {x, 0, -0.9});
  return mesh;
}

/// Two meshes, and where the second is when they interlock and the first is at the origin.
struct Interlocked {
  const char* name;
  MeshData first, second;
  Vec3 offset;
};

std::vector<Interlocked> interlockedShapes() {
  return {{"torus on rod", tools::makeTorus(1, 0.2, 24, 12), tools::makeRod(0.4, 6, 20), {0, 0, 0.1}},
          {"comb in comb", tools::makeComb(4, 1, 1.5, 0.3), looseComb(), {0, 0, 1.9}},
          {"hook in ring", tools::makeHook(4, 1.5, 1, 0.3), tools::makeTorus(1.5, 0.15, 32, 10), {-0.9, 0, -1.4}},
          {"rod in cup", tools::makeCup(1, 2, 0.2, 24), tools::makeRod(0.5, 3, 16), {0, 0, 2}}};
}

/// A rectangle of two triangles in the plane of axes `u` and `v`.
MeshData rectangle(int u, int v) {
  MeshData mesh;
  for (int i = 0; i < 4; ++i) {
    std::array<float, 3> p{};
    p[u] = i & 1 ? 1.0f : 0.0f;
    p[v] = i & 2 ? 1.0f : 0.0f;
    mesh.positions.insert(mesh.positions.end(), p.begin(), p.end());
  }
  mesh.indices = {0, 1, 2, 2, 1, 3};
  return mesh;
}

}  // namespace

TEST_CASE("interlocked shapes meet when and where the CPU says, either one as the sensor") {
  const size_t which = GENERATE(0, 1, 2, 3);
  const bool swapped = GENERATE(false, true);
  const Interlocked shapes = interlockedShapes()[which];
  CAPTURE(shapes.name, swapped);
  Random random(100 + which);
  Scene scene;
  const MeshId first = add(scene, shapes.first), second = add(scene, shapes.second);
  std::vector<Query> queries;
  for (int i = 0; i < 24; ++i) {
    const Vec3 home{40.0 * (i % 5), 40.0 * (i / 5), 0};
    const Transform poses[] = {
        tools::makePose(smallRotation(random, 0.05), kFull, home),
        tools::makePose(smallRotation(random, 0.05), kFull,
                        {home[0] + shapes.offset[0], home[1] + shapes.offset[1], shapes.offset[2]})};
    scene.addObject({swapped ? first : second, poses[swapped ? 0 : 1], ~0u});
    queries.push_back({.mesh = swapped ? second : first,
                       .worldFromMesh = poses[swapped ? 1 : 0],
                       .direction = random.direction(),
                       .distance = random.uniform(0.1, 8)});
  }
  const ContactTally tally = compareContact(scene, queries);
  CHECK(tally.hits >= 12);
}

TEST_CASE("boxes on a lattice that touch, tie and share outlines give the CPU's least pair") {
  const uint64_t seed = GENERATE(1, 2, 3, 4);
  CAPTURE(seed);
  Random random(seed);
  Scene scene;
  const MeshId box = add(scene, tools::makeBox({1, 1, 1}));
  const auto whole = [&](uint32_t limit) { return double(random.below(limit)); };
  for (int i = 0; i < 40; ++i) {
    scene.addObject({box, at({whole(12), whole(12), whole(12)}, {1 + whole(2), 1 + whole(2), 1 + whole(2)}), ~0u});
  }
  std::vector<Query> queries;
  for (int i = 0; i < 96; ++i) {
    Query query{.mesh = box, .worldFromMesh = at({whole(12), whole(12), whole(12)})};
    for (double& c : query.direction) c = random.below(2) == 0 ? 0 : whole(5) - 2;
    if (query.direction == Vec3{}) query.direction[i % 3] = 3;
    query.distance = whole(8);
    queries.push_back(query);
  }
  const ContactTally tally = compareContact(scene, queries);
  CHECK(tally.hits >= 5);
  CHECK(tally.overlaps >= 5);
  CHECK(tally.clear >= 5);
}

TEST_CASE("boxes in one line touch at the start, in flight and at exactly the distance") {
  Scene scene;
  const MeshId box = add(scene, tools::makeBox({1, 1, 1}));
  const ObjectId object = scene.addObject({box, at({0, 0, 4}), ~0u});
  const auto ask = [&](const Vec3& start, double distance) {
    return Query{.mesh = box, .worldFromMesh = at(start), .direction = {0, 0, 2}, .distance = distance};
  };
  std::vector<Query> queries{ask({0, 0, 0}, 3),
                             ask({0, 0, 0}, std::nextafter(3, 0)),
                             ask({0, 0, 0}, 10),
                             ask({0, 0, 3}, 1),
                             ask({0, 0, 3}, 0),
                             ask({0, 0, std::nextafter(3, 0)}, 0),
                             ask({0, 0, std::nextafter(3, 0)}, 1),
                             ask({0, 0, 4.5}, 5),
                             ask({0, 0, 5}, 5),
                             ask({0, 0, std::nextafter(5, 6)}, 5),
                             ask({1, 0, 0}, 9),
                             ask({std::nextafter(1, 2), 0, 0}, 9),
                             ask({1, 1, 0}, 9),
                             ask({1, 1, 0}, 3),
                             ask({1, 1, 3}, 0),
                             ask({-1, 0.5, 0}, 9)};
  compareContact(scene, queries);
  for (Query& query : queries) query.mode = Mode::contact;
  Sweeper sweeper(test::device(), scene, {.cpuBatch = 0});
  const std::vector<Result> results = sweeper.run(queries);
  CHECK((results[0].status == Status::hit && results[0].t == 3 && results[0].hi == 3));
  CHECK(results[0].object == object);
  CHECK(results[1].status == Status::clear);
  CHECK((results[2].status == Status::hit && results[2].t == 3));
  CHECK((results[3].status == Status::overlap && results[4].status == Status::overlap));
  CHECK(results[5].status == Status::clear);
  CHECK(results[6].status == Status::hit);
  CHECK((results[8].status == Status::overlap && results[9].status == Status::clear));
  CHECK((results[10].status == Status::hit && results[11].status == Status::clear));
}

TEST_CASE("plates that fly edge-on meet plates as the CPU says") {
  const bool thick = GENERATE(false, true);
  CAPTURE(thick);
  Random random(5);
  Scene scene;
  std::vector<MeshId> plates;
  for (auto [u, v] : {std::pair{0, 1}, std::pair{1, 2}, std::pair{2, 0}}) {
    const double side = 0.015625;
    plates.push_back(add(
        scene, thick ? tools::makeBox({u == 1 ? side : 1, u == 2 ? side : 1, u == 0 ? side : 1}) : rectangle(u, v)));
  }
  const auto place = [&] { return 0.5 * random.below(16); };
  for (int i = 0; i < 30; ++i) {
    scene.addObject({plates[random.below(3)], at({place(), place(), place()}, {2, 2, 2}), ~0u});
  }
  std::vector<Query> queries;
  for (int i = 0; i < 90; ++i) {
    Query query{.mesh = plates[i % 3], .worldFromMesh = at({place(), place(), place()}), .distance = place()};
    query.direction[i / 3 % 3] = i % 2 == 0 ? 1 : -0.75;
    if (i % 5 == 0) query.direction[(i / 3 + 1) % 3] = 1;
    queries.push_back(query);
  }
  const ContactTally tally = compareContact(scene, queries);
  CHECK(tally.hits >= 5);
  CHECK(tally.overlaps >= 5);
}

TEST_CASE("meshes in units so small or large that float cannot hold their poses meet as the CPU says") {
  const auto [unit, world] = GENERATE(table<double, double>({{1e-30, 1e12}, {1e25, 1e-18}, {1e20, 1e-21}, {1, 1}}));
  CAPTURE(unit, world);
  Random random(7);
  Scene scene;
  MeshData ball = tools::makeUvSphere(6, 9);
  for (float& x : ball.positions) x = static_cast<float>(x * unit);
  const MeshId mesh = add(scene, ball);
  const double scale = world / unit;
  const auto pose = [&, world = world] {
    const Vec3 place = random.inBox({-4, -4, -4}, {4, 4, 4});
    return tools::makePose(random.rotation(), {scale, scale, scale},
                           {world * place[0], world * place[1], world * place[2]});
  };
  for (int i = 0; i < 8; ++i) scene.addObject({mesh, pose(), ~0u});
  std::vector<Query> queries;
  for (int i = 0; i < 48; ++i) {
    queries.push_back({.mesh = mesh, .worldFromMesh = pose(), .direction = random.direction(), .distance = 12 * world});
  }
  const ContactTally tally = compareContact(scene, queries);
  CHECK(tally.hits >= 5);
  CHECK(tally.clear >= 5);
}

TEST_CASE("a mesh inside a mesh is clear until it meets the wall from within") {
  Scene scene;
  const MeshId ball = add(scene, tools::makeUvSphere(20, 30));
  scene.addObject({ball, at({0.1, 0.2, 0.3}, {5, 5, 5}), ~0u});
  const MeshId cup = add(scene, tools::makeCup(0.5, 1, 0.1, 12));
  Random random(3);
  std::vector<Query> queries;
  for (int i = 0; i < 32; ++i) {
    queries.push_back({.mesh = i % 2 == 0 ? cup : ball,
                       .worldFromMesh = tools::makePose(random.rotation(), kFull, random.inBox({-1, -1, -1}, kFull)),
                       .direction = random.direction(),
                       .distance = i % 3 == 0 ? 0.5 : 9.0});
  }
  const ContactTally tally = compareContact(scene, queries);
  CHECK(tally.clear == 11);
  CHECK(tally.hits == 21);
}

TEST_CASE("a distance of zero asks for overlap at the start") {
  tools::Workload workload =
      tools::makeWorkload(tools::Soups{.objects = 60, .sensors = 128, .triangles = 150, .seed = 8});
  for (tools::QuerySpec& query : workload.queries) query.distance = 0;
  const ContactTally tally = compareContact(workload);
  CHECK(tally.hits == 0);
  CHECK(tally.overlaps >= 3);
  CHECK(tally.clear >= 3);
}

TEST_CASE("two balls of many triangles meet as the CPU says, however often they are asked") {
  const uint32_t rings = GENERATE(100, 140, 180);
  CAPTURE(rings);
  Scene scene;
  const MeshId ball = add(scene, tools::makeUvSphere(rings, 2 * rings));
  scene.addObject({ball, {}, ~0u});
  // A search of many rounds.
  std::vector<Query> queries(
      4, {.mesh = ball, .worldFromMesh = at({-0.5, 0.25, -7}), .direction = {0, 0, 1}, .distance = 50});
  queries.push_back({.mesh = ball, .worldFromMesh = at({-1.25, 0.5, -7}), .direction = {0, 0, 1}, .distance = 50});
  for (int repeat = 0; repeat < 3; ++repeat) CHECK(compareContact(scene, queries).hits == queries.size());
}

TEST_CASE("two poles of many triangles each meet in every pair at once, and the least is told") {
  Scene scene;
  const MeshId ball = add(scene, tools::makeUvSphere(6, 40));
  scene.addObject({ball, {}, ~0u});
  scene.addObject({ball, {}, ~0u});
  const ContactTally tally =
      compareContact(scene, {{.mesh = ball, .worldFromMesh = at({0, 0, -7}), .direction = {0, 0, 2}, .distance = 50},
                             {.mesh = ball, .worldFromMesh = at({0, 0, -7}), .direction = {0, 0, 2}, .distance = 5},
                             {.mesh = ball, .worldFromMesh = at({0, 0, -2}), .direction = {0, 0, 2}, .distance = 5}});
  CHECK(tally.hits == 2);
  CHECK(tally.overlaps == 1);
}
