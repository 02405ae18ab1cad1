// A real assembly, whose parts touch and cross where they are joined: every part moved out along 26 directions.
#include <algorithm>

#include "agreement/real_meshes.h"
#include "import/mesh_import.h"
#include "radar/cpu_sweeper.h"
#include "support/catch.h"
#include "support/same_bits.h"
#include "support/test_device.h"

using namespace radar;

namespace {

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
  std::vector<std::string> warnings;
  const tools::Assembly assembly = tools::readAssembly(test::engineFile(), warnings);
  REQUIRE(warnings.empty());
  Scene scene;
  for (const tools::MeshData& mesh : assembly.meshes) scene.addMesh(mesh.positions, mesh.indices);
  for (const tools::Assembly::Part& part : assembly.parts) scene.addObject({part.mesh, part.fileFromNode});
  REQUIRE(scene.objectLimit() == 67);

  std::vector<Query> queries = disassembly(scene);
  CpuSweeper cpu(scene);
  const std::vector<Result> expected = cpu.run(queries).results;
  Sweeper sweeper(test::device(), scene, {.cpuBatch = 0});
  std::vector<Result> results = sweeper.run(queries).results;
  for (size_t i = 0; i < queries.size(); ++i) {
    INFO("object " << i / 26 << " direction " << i % 26);
    results[i].tier = expected[i].tier;
    REQUIRE(test::sameBits(results[i], expected[i]));
  }

  for (Query& query : queries) {
    query.skipOverlapping = true;
    query.hits = kAllHits;
  }
  const Answers skipped = cpu.run(queries);
  size_t crossing = 0, listed = 0;
  std::vector<Query> single;
  std::vector<Result> answers;
  for (size_t i = 0; i < queries.size(); ++i) {
    const auto& [hits, overlapping] = skipped.lists[i];
    crossing += overlapping.size();
    listed += hits.size();
    if (!hits.empty()) REQUIRE(test::sameBits(skipped.results[i], hits[0]));
    if (i % 23 != 0) continue;
    for (ObjectId id = 0; id < scene.objectLimit(); ++id) {
      Query alone = queries[i];
      alone.hits = 1;
      alone.skipOverlapping = false;
      for (ObjectId other = 0; other < scene.objectLimit(); ++other) {
        if (other != id) alone.exclude.push_back(other);
      }
      const auto found = std::find_if(hits.begin(), hits.end(), [&](const Result& hit) { return hit.object == id; });
      if (std::find(overlapping.begin(), overlapping.end(), id) != overlapping.end()) {
        REQUIRE(found == hits.end());
        continue;
      }
      single.push_back(alone);
      answers.push_back(found == hits.end() ? Result() : *found);
    }
  }
  const std::vector<Result> alone = cpu.run(single).results;
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
