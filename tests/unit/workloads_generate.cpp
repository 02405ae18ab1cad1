#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "support/catch.h"
#include "workloads/generate.h"
#include "workloads/hard_cases.h"

using namespace radar;
using namespace radar::tools;

namespace {

/// FNV-1a over the bits of all geometry.
class Fingerprint {
 public:
  template <class Value>
  void add(const Value& value) {
    unsigned char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    for (unsigned char byte : bytes) hash_ = (hash_ ^ byte) * 0x100000001b3ull;
  }
  void add(const Instance& instance) {
    add(instance.mesh);
    for (double value : instance.worldFromMesh.m) add(value);
  }
  uint64_t value() const { return hash_; }

 private:
  uint64_t hash_ = 0xcbf29ce484222325ull;
};

uint64_t fingerprintOf(const Workload& workload) {
  Fingerprint print;
  for (const MeshData& mesh : workload.meshes) {
    for (float value : mesh.positions) print.add(value);
    for (uint32_t index : mesh.indices) print.add(index);
  }
  for (const SceneSpec& scene : workload.scenes) {
    for (const Instance& instance : scene.instances) print.add(instance);
  }
  for (const QuerySpec& query : workload.queries) {
    print.add(query.sensor());
    for (double value : query.direction) print.add(value);
    print.add(query.distance);
  }
  return print.value();
}

std::array<float, 3> vertexOf(const MeshData& mesh, uint32_t index) {
  return {mesh.positions[3 * index], mesh.positions[3 * index + 1], mesh.positions[3 * index + 2]};
}

bool hasDegenerateTriangle(const MeshData& mesh) {
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto a = vertexOf(mesh, mesh.indices[i]), b = vertexOf(mesh, mesh.indices[i + 1]),
               c = vertexOf(mesh, mesh.indices[i + 2]);
    if (a == b || b == c || c == a) return true;
  }
  return false;
}

bool isClosed(const MeshData& mesh) {
  std::map<std::pair<uint32_t, uint32_t>, int> edges;  // forward uses minus backward uses
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    for (int k = 0; k < 3; ++k) {
      const uint32_t from = mesh.indices[i + k], to = mesh.indices[i + (k + 1) % 3];
      edges[{std::min(from, to), std::max(from, to)}] += from < to ? 1 : -1;
    }
  }
  for (const auto& [edge, balance] : edges) {
    if (balance != 0) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("the teapot has 6,320 triangles, none of them degenerate") {
  const MeshData teapot = makeTeapot();
  CHECK(teapot.triangleCount() == 6320);
  CHECK_FALSE(hasDegenerateTriangle(teapot));
  const MeshExtent extent = extentOf(teapot);
  CHECK(extent.longest == Approx(6.434).epsilon(1e-3));
  CHECK(extent.middle[1] == 0);
}

TEST_CASE("generated shapes are closed and have no degenerate triangle") {
  for (const MeshData& mesh :
       {makeBox({1, 2, 3}), makeUvSphere(9, 16), makeTorus(3, 1, 20, 11), makeRod(1, 5, 13), makeCup(2, 3, 0.2, 17),
        makePlate(4, 5, 0.1), makeComb(5, 1, 2, 0.3), makeHook(4, 2, 1, 0.3), makeKey(), makeKeyhole()}) {
    CAPTURE(mesh.name);
    CHECK(isClosed(mesh));
    CHECK_FALSE(hasDegenerateTriangle(mesh));
  }
}

TEST_CASE("circlePoint gives points on the circle that are symmetric to the bit") {
  for (uint32_t n : {3u, 7u, 8u, 12u, 100u}) {
    for (uint32_t k = 0; k < n; ++k) {
      const auto [c, s] = circlePoint(k, n);
      CHECK(c == Approx(std::cos(2 * std::acos(-1.0) * k / n)).margin(1e-15));
      CHECK(s == Approx(std::sin(2 * std::acos(-1.0) * k / n)).margin(1e-15));
      const auto [mirrorC, mirrorS] = circlePoint(n - k, n);
      CHECK(mirrorC == c);
      CHECK(mirrorS == -s);
    }
  }
}

TEST_CASE("a workload has the same bits always and everywhere") {
  const RandomPoses poses{{makeTorus(2, 0.5, 12, 8), makeCup(1, 2, 0.1, 12)}, 20, 8, 17};
  // Recorded once; a change here changes every benchmark and every recorded answer.
  CHECK(fingerprintOf(makeWorkload(Table1{500, 16, SensorShape::teapot, 1})) == 0x54cac98db512626eull);
  CHECK(fingerprintOf(makeWorkload(Table1{500, 16, SensorShape::box, 1})) == 0xe418389a437273fcull);
  CHECK(fingerprintOf(makeWorkload(Figure7{6, 300, 5, 7})) == 0xb0112bc0e6e512fbull);
  CHECK(fingerprintOf(makeWorkload(Scale{1000, 32, SensorShape::box, 11})) == 0xa0fa6130d5cc640ull);
  CHECK(fingerprintOf(makeWorkload(OneMesh{10'000, 16, SensorShape::teapot, 19})) == 0x20a240b1ded4dc12ull);
  CHECK(fingerprintOf(makeWorkload(Soups{})) == 0x180343bab99329cfull);
  CHECK(fingerprintOf(makeWorkload(poses)) == 0x64d72d9557e3e7c6ull);
}

TEST_CASE("another seed gives another workload") {
  CHECK(fingerprintOf(makeWorkload(Table1{500, 16, SensorShape::box, 1})) !=
        fingerprintOf(makeWorkload(Table1{500, 16, SensorShape::box, 2})));
}

TEST_CASE("a larger Table 1 scene begins with the smaller one") {
  const Workload small = makeWorkload(Table1{1000}), large = makeWorkload(Table1{3000});
  const auto& boxes = large.scenes[0].instances;
  CHECK(std::equal(small.scenes[0].instances.begin(), small.scenes[0].instances.end(), boxes.begin()));
}

TEST_CASE("sensors over one mesh begin above all geometry below them") {
  const Workload workload = makeWorkload(OneMesh{.triangles = 20'000, .sensors = 64, .shape = SensorShape::box});
  const MeshData& city = workload.meshes[2];
  CHECK(city.triangleCount() == 20'000);
  for (const QuerySpec& query : workload.queries) {
    const auto& m = query.worldFromMesh.m;
    double radius = 0;  // of the sphere around a unit box, placed
    for (int k = 0; k < 3; ++k) radius += 0.25 * (m[k] * m[k] + m[4 + k] * m[4 + k] + m[8 + k] * m[8 + k]);
    radius = std::sqrt(radius);
    for (size_t v = 0; v < city.vertexCount(); ++v) {
      const float* p = &city.positions[3 * v];
      if (std::abs(p[0] - m[3]) <= radius && std::abs(p[1] - m[7]) <= radius) REQUIRE(p[2] < m[11] - radius);
    }
  }
}

TEST_CASE(
    "each step of Figure 7 is a scene based on the boxes in which every teapot is a sensor that excludes itself") {
  const Workload workload = makeWorkload(Figure7{4, 50, 3});
  REQUIRE(workload.scenes.size() == 4);
  REQUIRE(workload.queries.size() == 12);
  for (uint32_t step = 0; step < 3; ++step) {
    const SceneSpec& scene = workload.scenes[step + 1];
    CHECK(scene.base == 0u);
    CHECK(workload.objectCount(step + 1) == 54);
    for (uint32_t teapot = 0; teapot < 4; ++teapot) {
      const QuerySpec& query = workload.queries[4 * step + teapot];
      CHECK(query.scene == step + 1);
      CHECK(query.batch == step);
      CHECK(query.exclude == std::vector<uint32_t>{50 + teapot});
      CHECK(query.sensor() == scene.instances[teapot]);
    }
  }
}

TEST_CASE("every generated workload keeps the contracts of Scene and Query") {
  for (const Workload& workload :
       {makeWorkload(Table1{300, 8}), makeWorkload(Figure7{5, 60, 4}), makeWorkload(Scale{200, 8}),
        makeWorkload(OneMesh{20'000, 8}), makeWorkload(Soups{}), makeWorkload(Soups{9, 9, 5, 1e5}),
        makeWorkload(RandomPoses{{makeTeapot(), makeBox({1, 1, 1})}, 9, 9})}) {
    ScenePlayer player(workload);
    for (const QuerySpec& query : workload.queries) {
      player.show(query.scene);
      CHECK(validate(query, player.scene(), radar::Mode::sampled).empty());
    }
  }
}

TEST_CASE("hard cases keep the contracts of Scene and Query and have the same bits everywhere") {
  Fingerprint all;
  for (const HardFamily& family : hardFamilies()) {
    CAPTURE(family.name);
    for (const Company company : {Company::isolated, Company::mixed}) {
      const Workload workload = hardScene(family, 1, 0, kIsolatedCases, company);
      all.add(fingerprintOf(workload));
      CHECK(fingerprintOf(workload) != fingerprintOf(hardScene(family, 2, 0, kIsolatedCases, company)));
      CHECK(workload.queries.size() == kIsolatedCases);
      Scene scene;
      replaceBy(workload, 0, scene);
      for (const QuerySpec& query : workload.queries) {
        CHECK(validate(query, scene).empty());
      }
    }
  }
  // Recorded once, as above.
  CHECK(all.value() == 0x39f4ec567432aeadull);
}

TEST_CASE("isolated cases meet their own objects only") {
  const HardFamily& family = hardFamily("ties");
  const Workload workload = hardScene(family, 1, 0, kIsolatedCases, Company::isolated);
  REQUIRE(workload.scenes[0].masks.size() == workload.scenes[0].instances.size());
  size_t object = 0;
  for (uint32_t i = 0; i < kIsolatedCases; ++i) {
    CHECK(workload.queries[i].mask == 1u << i);
    for (size_t own = hardCase(family, 1, i).objects.size(); own > 0; --own, ++object) {
      CHECK(workload.scenes[0].masks[object] == ObjectMask{object, 1u << i});
    }
  }
  CHECK(object == workload.scenes[0].instances.size());
  CHECK(hardScene(family, 1, 0, 40, Company::mixed).scenes[0].masks.empty());
}
