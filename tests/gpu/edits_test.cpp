// Answers after any sequence of edits are those of a scene that is built anew, to the bit.
#include "radar/cpu_sweeper.h"
#include "support/catch.h"
#include "support/resident.h"
#include "support/same_bits.h"
#include "support/test_device.h"
#include "workloads/same_answer.h"
#include "workloads/shapes.h"

namespace {

using namespace radar;

/// A scene of some hundred objects, and edits of every kind.
class Edited {
 public:
  explicit Edited(uint64_t seed) : random_(seed) {
    for (int i = 0; i < 4; ++i) addMesh();
    for (int i = 0; i < 300; ++i) scene_.addObject({anyMesh(), somewhere()});
  }
  const Scene& scene() const { return scene_; }
  tools::Random& random() { return random_; }
  MeshId anyMesh() { return meshes_[random_.below(static_cast<uint32_t>(meshes_.size()))]; }
  Transform somewhere() { return random_.affine(random_.inCube(25)); }

  void edit() {
    const ObjectId id = random_.below(scene_.objectLimit() + 1);
    const uint32_t what = random_.below(20);
    if (!scene_.hasObject(id)) {
      scene_.addObject({anyMesh(), somewhere(), random_.oneIn(5) ? 2u : ~0u});
    } else if (what < 10) {
      scene_.setTransform(id, somewhere());
    } else if (what < 14) {
      scene_.removeObject(id);
    } else if (what < 16) {
      deform(anyMesh());
    } else if (what < 18 && meshes_.size() < 12) {
      addMesh();
    } else {
      replaceMesh(random_.below(static_cast<uint32_t>(meshes_.size())));
    }
  }

  std::vector<Query> queries() {
    std::vector<Query> queries(24);
    for (Query& query : queries) {
      query = {.mesh = anyMesh(), .worldFromMesh = somewhere()};
      query.direction = random_.direction();
      query.distance = random_.uniform(1, 40);
      query.mask = random_.oneIn(4) ? 1u : ~0u;
    }
    return queries;
  }

  /// A new scene with the same ids.
  Scene again() const {
    Scene scene;
    const MeshView any = scene_.mesh(meshes_[0]);
    for (MeshId id = 0; id < scene_.meshLimit(); ++id) {
      const MeshView mesh = scene_.hasMesh(id) ? scene_.mesh(id) : any;
      scene.addMesh(mesh.positions, mesh.indices);
    }
    for (ObjectId id = 0; id < scene_.objectLimit(); ++id) {
      scene.addObject(scene_.hasObject(id) ? scene_.object(id) : Object{.mesh = meshes_[0]});
    }
    for (ObjectId id = 0; id < scene_.objectLimit(); ++id) {
      if (!scene_.hasObject(id)) scene.removeObject(id);
    }
    return scene;
  }

 private:
  void addMesh() {
    const tools::MeshData soup = tools::makeSoup(tools::Soup::plain, 1 + random_.below(60), random_);
    meshes_.push_back(scene_.addMesh(soup.positions, soup.indices));
  }
  void deform(MeshId mesh) {
    const MeshView view = scene_.mesh(mesh);
    std::vector<float> positions(view.positions.begin(), view.positions.end());
    for (float& p : positions) p += static_cast<float>(random_.uniform(-0.2, 0.2));
    scene_.setPositions(mesh, positions);
  }
  /// Another mesh takes its id, and its objects go.
  void replaceMesh(size_t which) {
    const MeshId old = meshes_[which];
    for (ObjectId id = 0; id < scene_.objectLimit(); ++id) {
      if (scene_.hasObject(id) && scene_.object(id).mesh == old) scene_.removeObject(id);
    }
    scene_.removeMesh(old);
    meshes_.erase(meshes_.begin() + static_cast<ptrdiff_t>(which));
    addMesh();
  }

  tools::Random random_;
  Scene scene_;
  std::vector<MeshId> meshes_;
};

}  // namespace

TEST_CASE("after random edits, a sweeper's answers on the device have the bits of those about a scene built anew") {
  const uint64_t seed = GENERATE(range(1, 4));
  Edited edited(seed);
  Sweeper sweeper(test::device(), edited.scene(), {.cpuBatch = 0});
  size_t hits = 0;
  for (int round = 0; round < 25; ++round) {
    for (uint32_t edits = edited.random().below(round % 5 == 0 ? 200 : 6); edits-- > 0;) edited.edit();
    const std::vector<Query> queries = edited.queries();
    const Scene again = edited.again();
    Sweeper fresh(test::device(), again, {.cpuBatch = 0});
    const std::vector<Result> results = sweeper.run(queries).results, expected = fresh.run(queries).results;
    for (size_t i = 0; i < queries.size(); ++i) {
      CAPTURE(seed, round, i);
      REQUIRE(test::sameBits(results[i], expected[i]));
      hits += results[i].status == Status::hit;
    }
  }
  CHECK(hits > 100);
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("10,000 steps of edits and queries leave the process no larger than the first 2,000", "[.long]") {
  Edited edited(4);
  Sweeper sweeper(test::device(), edited.scene(), {.cpuBatch = 0});
  CpuSweeper cpu(edited.scene());
  size_t before = 0;
  for (int step = 0; step < 10'000; ++step) {
    if (step == 2'000) before = test::residentBytes();
    for (int edits = 0; edits < 10; ++edits) edited.edit();
    const std::vector<Query> queries = edited.queries();
    const std::vector<Result> results = sweeper.run(queries).results, expected = cpu.run(queries).results;
    for (size_t i = 0; i < queries.size(); ++i) REQUIRE(tools::sameAnswer(results[i], expected[i]));
  }
  const size_t after = test::residentBytes();
  INFO(before << " bytes before, " << after << " after");
  CHECK(after < before + before / 50);
}
