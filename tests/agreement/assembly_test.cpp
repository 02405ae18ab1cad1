// A real assembly, whose parts touch and cross where they are joined: every part moved out along 26 directions.
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <catch2/catch.hpp>

#include "radar/cpu_sweeper.h"
#include "support/same_bits.h"
#include "support/test_device.h"

using namespace radar;

namespace {

/// One object per node that has triangles, in its place.
void addNodes(const aiScene& file, const aiNode& node, const aiMatrix4x4& parent, Scene& scene) {
  const aiMatrix4x4 world = parent * node.mTransformation;
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  for (unsigned m = 0; m < node.mNumMeshes; ++m) {
    const aiMesh& mesh = *file.mMeshes[node.mMeshes[m]];
    const auto first = static_cast<uint32_t>(positions.size() / 3);
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D& p = mesh.mVertices[v];
      positions.insert(positions.end(), {p.x, p.y, p.z});
    }
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      REQUIRE(mesh.mFaces[f].mNumIndices == 3);
      for (unsigned i = 0; i < 3; ++i) indices.push_back(first + mesh.mFaces[f].mIndices[i]);
    }
  }
  if (!indices.empty()) {
    const Transform pose{{world.a1, world.a2, world.a3, world.a4, world.b1, world.b2, world.b3, world.b4, world.c1,
                          world.c2, world.c3, world.c4}};
    scene.addObject({scene.addMesh(positions, indices), pose});
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) addNodes(file, *node.mChildren[i], world, scene);
}

/// Each object, as it stands, moves out of the others along 26 directions.
std::vector<Query> disassembly(const Scene& scene) {
  std::vector<Query> queries;
  for (ObjectId id = 0; id < scene.objectLimit(); ++id) {
    for (int i = 0; i < 27; ++i) {
      if (i == 13) continue;
      Query query{.mesh = scene.object(id).mesh, .worldFromMesh = scene.object(id).worldFromMesh, .distance = 1e4};
      const std::array<int, 3> direction{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
      std::copy(direction.begin(), direction.end(), query.direction.begin());
      query.exclude = {id};
      query.ignoreLeaving = true;
      queries.push_back(query);
    }
  }
  return queries;
}

}  // namespace

TEST_CASE("the parts of an engine are swept out of it with the CPU's answers, and each object's contact is its own") {
  Assimp::Importer importer;
  const aiScene* file = importer.ReadFile(RADAR_ENGINE, 0);
  REQUIRE(file != nullptr);
  Scene scene;
  addNodes(*file, *file->mRootNode, aiMatrix4x4(), scene);
  REQUIRE(scene.objectLimit() == 67);

  std::vector<Query> queries = disassembly(scene);
  CpuSweeper cpu(scene);
  const std::vector<Result> expected = cpu.run(queries);
  Sweeper sweeper(test::device(), scene, {.cpuBatch = 0});
  std::vector<Result> results = sweeper.run(queries);
  for (size_t i = 0; i < queries.size(); ++i) {
    INFO("object " << i / 26 << " direction " << i % 26);
    results[i].tier = expected[i].tier;
    REQUIRE(test::sameBits(results[i], expected[i]));
  }

  for (Query& query : queries) {
    query.skipOverlapping = true;
    query.hits = kAllHits;
  }
  const std::vector<Result> skipped = cpu.run(queries);
  const Lists lists = cpu.lists();
  size_t crossing = 0, listed = 0;
  std::vector<Query> single;
  std::vector<Result> answers;
  for (size_t i = 0; i < queries.size(); ++i) {
    crossing += lists.overlappingOf(i).size();
    listed += lists.hitsOf(i).size();
    if (!lists.hitsOf(i).empty()) REQUIRE(test::sameBits(skipped[i], lists.hitsOf(i)[0]));
    if (i % 23 != 0) continue;
    for (ObjectId id = 0; id < scene.objectLimit(); ++id) {
      Query alone = queries[i];
      alone.hits = 1;
      alone.skipOverlapping = false;
      for (ObjectId other = 0; other < scene.objectLimit(); ++other) {
        if (other != id) alone.exclude.push_back(other);
      }
      const auto hits = lists.hitsOf(i);
      const auto found = std::find_if(hits.begin(), hits.end(), [&](const Result& hit) { return hit.object == id; });
      const auto overlapping = lists.overlappingOf(i);
      if (std::find(overlapping.begin(), overlapping.end(), id) != overlapping.end()) {
        REQUIRE(found == hits.end());
        continue;
      }
      single.push_back(alone);
      answers.push_back(found == hits.end() ? Result() : *found);
    }
  }
  const std::vector<Result> alone = cpu.run(single);
  for (size_t i = 0; i < single.size(); ++i) {
    if (alone[i].status == Status::clear) {
      REQUIRE(answers[i].status == Status::invalid);  // not listed
    } else {
      REQUIRE(test::sameBits(alone[i], answers[i]));
    }
  }
  REQUIRE(crossing > 100);
  REQUIRE(listed > 1000);
}
