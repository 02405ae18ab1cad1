// The scene: ids, contracts, boxes and frames.
#include <sys/mman.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "math/frame.h"
#include "scene/scene.h"
#include "support/catch.h"
#include "support/world.h"
#include "workloads/generate.h"

namespace {

using namespace radar;

MeshId addBox(Scene& scene) {
  const tools::MeshData box = tools::makeBox({1, 2, 3});
  return scene.addMesh(box.positions, box.indices);
}

// As many zeros, which take no memory until they are read.
template <class T>
class Zeros {
 public:
  explicit Zeros(size_t count)
      : bytes_(count * sizeof(T)),
        at_(mmap(nullptr, bytes_, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0)) {
    REQUIRE(at_ != MAP_FAILED);
  }
  ~Zeros() { munmap(at_, bytes_); }
  Zeros(const Zeros&) = delete;
  Zeros& operator=(const Zeros&) = delete;
  std::span<const T> all() const { return {static_cast<const T*>(at_), bytes_ / sizeof(T)}; }

 private:
  size_t bytes_;
  void* at_;
};

Box placedBox(const Mesh& mesh, const Transform& pose) {
  Box box;
  for (uint32_t v : mesh.indices) box.add(transformPoint(pose, &mesh.positions[3 * size_t{v}]));
  return box;
}

}  // namespace

TEST_CASE("ids stay valid when others are removed, and the lowest free id is given next") {
  Scene scene;
  const MeshId mesh = addBox(scene);
  CHECK(scene.addObject({mesh, {}, 1u}) == 0);
  CHECK(scene.addObject({mesh, {}, 2u}) == 1);
  CHECK(scene.addObject({mesh, {}, 4u}) == 2);
  scene.removeObject(1);
  scene.removeObject(0);
  CHECK(scene.hasObject(2));
  CHECK(scene.object(2).mask == 4u);
  CHECK_FALSE(scene.hasObject(0));
  CHECK(scene.addObject({mesh, {}, 8u}) == 0);
  CHECK(scene.addObject({mesh, {}, 16u}) == 1);
  CHECK(scene.addObject({mesh, {}, 32u}) == 3);
}

TEST_CASE("a mesh of more vertices or triangles than a link counts is refused before it is read") {
  Scene scene;
  const std::vector<float> few(9);
  const std::vector<uint32_t> triangle{0, 1, 2};
  const Zeros<float> positions(3 * ((size_t{1} << 30) + 1));
  const Zeros<uint32_t> indices(3 * ((size_t{1} << 29) + 1));
  CHECK_THROWS_WITH(scene.addMesh(positions.all(), triangle), test::Contains("expected at most 1073741824 vertices"));
  CHECK_THROWS_WITH(scene.addMesh(few, indices.all()), test::Contains("expected at most 536870912 triangles"));
  CHECK(scene.meshLimit() == 0);
}

TEST_CASE("a mesh in use cannot be removed, and every change changes the version") {
  Scene scene;
  const MeshId mesh = addBox(scene);
  uint64_t version = scene.version();
  const auto changed = [&] { return std::exchange(version, scene.version()) != scene.version(); };
  const ObjectId object = scene.addObject({mesh, {}, ~0u});
  CHECK(changed());
  CHECK_FALSE(changed());
  CHECK_THROWS_WITH(scene.removeMesh(mesh), test::Contains("used by 1"));
  scene.setTransform(object, {{2, 0, 0, 1, 0, 2, 0, 1, 0, 0, 2, 1}});
  CHECK(changed());
  scene.removeObject(object);
  CHECK(changed());
  scene.removeMesh(mesh);
  CHECK(changed());
  CHECK(addBox(scene) == mesh);
}

TEST_CASE("a view of a mesh stays valid, and shows what setPositions sets") {
  Scene scene;
  const MeshId mesh = addBox(scene);
  const MeshView view = scene.mesh(mesh);
  std::vector<float> moved(view.positions.begin(), view.positions.end());
  for (float& x : moved) x += 3;
  for (int i = 0; i < 20; ++i) addBox(scene);
  scene.setPositions(mesh, moved);
  CHECK(scene.mesh(mesh).positions.data() == view.positions.data());
  CHECK(std::equal(moved.begin(), moved.end(), view.positions.begin()));
}

TEST_CASE("of the faults of a large mesh, the first is named") {
  constexpr uint32_t kCount = 300'000;  // more than a thread looks at
  Scene scene;
  std::vector<float> positions(3 * size_t{kCount});
  std::vector<uint32_t> indices(kCount);
  indices[150'001] = kCount;
  indices[280'000] = kCount + 5;
  CHECK_THROWS_WITH(scene.addMesh(positions, indices),
                    test::Contains("triangle 50000 refers to vertex 300000 of 300000"));
  positions[3 * 200'000] = NAN;
  positions[3 * 250'000 + 1] = INFINITY;
  CHECK_THROWS_WITH(scene.addMesh(positions, indices), test::Contains("vertex 200000 is not finite"));
}

TEST_CASE("a call that breaks its contract throws and describes the error") {
  Scene scene;
  const MeshId mesh = addBox(scene);
  const std::vector<float> corner{0, 0, 0, 1, 0, 0, 0, 1, 0};
  CHECK_THROWS_WITH(scene.addMesh(corner, {}), test::Contains("at least one triangle"));
  CHECK_THROWS_WITH(scene.addMesh(corner, std::vector<uint32_t>{0, 1, 3}), test::Contains("vertex 3 of 3"));
  CHECK_THROWS_WITH(scene.addMesh(corner, std::vector<uint32_t>{0, 1}), test::Contains("3 per triangle"));
  CHECK_THROWS_WITH(
      scene.addMesh(std::vector<float>{0, 2e36f, 0}, std::vector<uint32_t>{0, 0, 0}, Bounds{{-1, -1, -1}, {1, 1, 1}}),
      test::Contains("vertex 0 of a mesh with bounds: expected coordinates of at most 2^120"));
  CHECK_THROWS_WITH(scene.addMesh(std::vector<float>{0, 0, NAN}, std::vector<uint32_t>{0, 0, 0}),
                    test::Contains("vertex 0 is not finite"));
  CHECK_THROWS_WITH(scene.addObject({mesh + 1, {}, ~0u}), test::Contains("does not exist"));
  CHECK_THROWS_WITH(scene.addObject({mesh, {{1, 0, 0, 0, 2, 0, 0, 0, 0, 0, 1, 0}}, ~0u}), test::Contains("singular"));
  CHECK_THROWS_WITH(scene.setTransform(0, {}), test::Contains("does not exist"));
  CHECK_THROWS_WITH(scene.removeObject(7), test::Contains("does not exist"));
  CHECK(validate(Transform{{1e-6, 0, 0, 0, 0, 1e-6, 0, 0, 0, 0, 1e-6, 0}}).empty());
  CHECK(validate(Transform{{1, 0, 0, INFINITY, 0, 1, 0, 0, 0, 0, 1, 0}}).find("finite") != std::string::npos);
}

TEST_CASE("many transforms are set at once, or none") {
  Scene scene;
  const MeshId mesh = addBox(scene);
  constexpr size_t kCount = 20'000;
  std::vector<ObjectId> objects;
  std::vector<Transform> poses;
  const auto at = [](double x) { return test::at(x, 0, 0); };
  for (size_t i = 0; i < kCount; ++i) {
    objects.push_back(scene.addObject({.mesh = mesh}));
    poses.push_back(at(double(i)));
  }
  const auto areAt = [&](double offset) {
    return std::ranges::all_of(objects,
                               [&](ObjectId id) { return scene.object(id).worldFromMesh.m[3] == id + offset; });
  };
  const uint64_t before = scene.version();
  scene.setTransforms(objects, poses);
  CHECK(areAt(0));
  CHECK(scene.version() > before);
  for (Transform& pose : poses) pose.m[3] += 5;
  // The last one counts if an object is given twice.
  objects.push_back(7);
  poses.push_back(at(-1));
  scene.setTransforms(objects, poses);
  CHECK(scene.object(7).worldFromMesh.m[3] == -1);
  scene.setTransform(7, at(12));
  objects.pop_back();
  poses.pop_back();
  CHECK(areAt(5));
  for (Transform& pose : poses) pose.m[3] += 1;
  poses[15'000].m[0] = NAN;
  poses[9'000] = Transform{};
  poses[9'000].m[5] = 0;
  CHECK_THROWS_WITH(scene.setTransforms(objects, poses),
                    test::Contains("setTransforms: object 9000: expected an invertible matrix"));
  objects[4] = 30'000;
  CHECK_THROWS_WITH(scene.setTransforms(objects, poses), "setTransforms: object 30000 does not exist");
  objects[4] = 4;
  CHECK_THROWS_WITH(scene.setTransforms(objects, {poses.data(), 3}),
                    "setTransforms: expected one transform per object, got 3 for 20000 objects");
  CHECK(areAt(5));
}

TEST_CASE("a pose that would place vertices at infinity is refused") {
  // Vertices of 10^30 and a pose of 10^300 made sums of infinities, whose contacts had no time and no normal.
  Scene scene;
  const MeshId mesh =
      scene.addMesh(std::vector<float>{0, 0, 0, 1e30f, 0, 0, 0, 1e30f, 0}, std::vector<uint32_t>{0, 1, 2});
  const auto refused = test::Contains("expected 12 finite numbers of at most 2^800");
  const Transform huge{{1e300, -1e300, 0, 0, 1e300, 1e300, 0, 0, 0, 0, 1e300, 0}};
  const Transform far{{1, 0, 0, 0, 0, 1, 0, -1e241, 0, 0, 1, 0}},
      least{{0x1p800, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -0x1p800}};
  const ObjectId object = scene.addObject({.mesh = mesh, .worldFromMesh = least});
  for (const Transform& pose : {huge, far}) {
    CHECK_THROWS_WITH(scene.addObject({.mesh = mesh, .worldFromMesh = pose}), refused);
    CHECK_THROWS_WITH(scene.setTransform(object, pose), refused);
    CHECK_THAT(validate({.mesh = mesh, .worldFromMesh = pose, .direction = {0, 0, 1}}, scene), refused);
  }
}

TEST_CASE("the box of a placed mesh contains every vertex, near and far from the origin") {
  tools::Random random(5);
  Scene scene;
  for (const tools::Soup soup : tools::kSoups) {
    const tools::MeshData data = tools::makeSoup(soup, 50, random);
    const Mesh& mesh = scene.impl().meshes[scene.addMesh(data.positions, data.indices)];
    for (int i = 0; i < 50; ++i) {
      const double away = std::pow(10.0, random.uniform(-3, 8));
      const double s = std::pow(10.0, random.uniform(-4, 4));
      const Transform pose =
          tools::makePose(random.rotation(), {s, s, s}, random.inBox({-away, -away, -away}, {away, away, away}));
      const Box outer = boxOf(mesh, pose.m), inner = placedBox(mesh, pose);
      for (int k = 0; k < 3; ++k) {
        CHECK(outer.lo[k] <= inner.lo[k]);
        CHECK(outer.hi[k] >= inner.hi[k]);
      }
    }
  }
}

TEST_CASE("axes along a direction are orthonormal, and exact for directions along the world's axes") {
  tools::Random random(3);
  for (int i = 0; i < 1000; ++i) {
    Vector direction = random.direction();
    const double length = std::pow(10.0, random.uniform(-100, 100));
    for (double& c : direction) c *= length;
    const std::array<Vector, 3> axes = axesAlong(direction);
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) CHECK(dot(axes[a], axes[b]) == Approx(a == b).margin(1e-15));
    }
    CHECK(dot(axes[2], direction) == Approx(length));
  }
  for (int k = 0; k < 3; ++k) {
    Vector direction{};
    direction[k] = -2.5;
    for (const Vector& axis : axesAlong(direction)) {
      for (double c : axis) CHECK((c == 0 || std::abs(c) == 1));
    }
  }
}
