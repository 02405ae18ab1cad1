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

TEST_CASE("the parts of an engine are swept out of it with the CPU's answers") {
  std::vector<std::string> warnings;
  const tools::Assembly assembly = tools::readAssembly(test::engineFile(), warnings);
  REQUIRE(warnings.empty());
  Scene scene;
  for (const tools::MeshData& mesh : assembly.meshes) scene.addMesh(mesh.positions, mesh.indices);
  for (const tools::Assembly::Part& part : assembly.parts) scene.addObject({part.mesh, part.fileFromNode});
  REQUIRE(scene.objectLimit() == 67);

  const std::vector<Query> queries = disassembly(scene);
  const Answers found = Sweeper(test::device(), scene, {.cpuBatch = 0}).run(queries);
  REQUIRE(test::differenceOf(found, CpuSweeper(scene).run(queries), test::sameButTier) == "");
}
