#include "measure/case.h"

#include <algorithm>

#include "workloads/generate.h"
#include "workloads/hard_cases.h"

namespace radar::tools {

namespace {

// Scenes and queries of `more` after those of `workload`.
void append(Workload& workload, Workload more) {
  const auto meshes = static_cast<uint32_t>(workload.meshes.size());
  const auto scenes = static_cast<uint32_t>(workload.scenes.size());
  for (SceneSpec& scene : more.scenes) {
    if (scene.base) *scene.base += scenes;
    for (Instance& instance : scene.instances) instance.mesh += meshes;
    workload.scenes.push_back(std::move(scene));
  }
  for (QuerySpec& query : more.queries) {
    query.scene += scenes;
    query.mesh += meshes;
    workload.queries.push_back(std::move(query));
  }
  std::move(more.meshes.begin(), more.meshes.end(), std::back_inserter(workload.meshes));
}

uint32_t of(Extent extent, uint32_t full, uint32_t quick, uint32_t least) {
  return extent == Extent::full ? full : extent == Extent::quick ? quick : least;
}

// As many scenes of each family, one after the other.
Workload familyScenes(std::initializer_list<const char*> families, Extent extent, Company company) {
  Workload workload;
  const auto count = static_cast<uint32_t>(families.size());
  const uint32_t scenes = (of(extent, 6, 3, 1) + count - 1) / count, cases = of(extent, kIsolatedCases, 16, 6);
  for (const char* family : families) {
    for (uint32_t i = 0; i < scenes; ++i) append(workload, hardScene(hardFamily(family), 1, i * cases, cases, company));
  }
  return workload;
}

}  // namespace

std::vector<Case> frontCases(Extent extent) {
  const uint32_t boxes = of(extent, 30'000, 10'000, 200), sensors = of(extent, 64, 16, 4);
  const uint32_t teapots = of(extent, 30, 10, 3);
  std::vector<Case> cases;
  const auto add = [&](const char* name, std::string about, Workload workload) {
    cases.push_back({"front", name, std::move(about), 0, std::move(workload)});
  };
  const std::string among = " among " + std::to_string(boxes) + " boxes (the paper's Table 1)";
  add("table1-teapots", "Teapots of 6,320 triangles" + among, makeWorkload(Table1{.boxes = boxes, .sensors = sensors}));
  add("table1-boxes", "Boxes" + among,
      makeWorkload(Table1{.boxes = boxes, .sensors = sensors, .shape = SensorShape::box}));
  add("figure7", std::to_string(teapots) + " teapots fly among 2,000 boxes (the paper's Figure 7)",
      makeWorkload(Figure7{.teapots = teapots, .steps = of(extent, 4, 2, 1)}));
  add("convex", "Convex shapes: boxes, balls, rods and plates", familyScenes({"convex"}, extent, Company::mixed));
  add("non-convex", "Non-convex shapes: teapots, rings, hooks, combs and cups",
      familyScenes({"non-convex"}, extent, Company::mixed));
  add("interlocking", "Interlocking shapes: ring on peg, hook behind bar, key in keyhole",
      familyScenes({"interlocking"}, extent, Company::isolated));
  add("thin", "Thin and open shapes: sheets, open cylinders, plates and rods along and just off the axes",
      familyScenes({"open", "direction"}, extent, Company::mixed));
  add("grazing", "Grazing: needles, plates edge-on, faces along the motion, near misses and near hits",
      familyScenes({"thin", "edge-on", "slope", "near"}, extent, Company::isolated));
  return cases;
}

Case meshesCase(Extent extent, std::vector<MeshData> meshes) {
  std::string about = "Real meshes in random poses:";
  for (const MeshData& mesh : meshes) {
    about += (&mesh == &meshes.front() ? " " : ", ") + mesh.name + " (" + std::to_string(mesh.triangleCount()) + ")";
  }
  Workload workload = makeWorkload(RandomPoses{.meshes = std::move(meshes), .sensors = of(extent, 64, 16, 4)});
  return {"front", "meshes", about + " triangles", 0, std::move(workload)};
}

std::vector<Case> table1Cases(Extent extent) {
  std::vector<Case> cases;
  const uint32_t step = of(extent, 2'000, 10'000, 20'000);
  for (uint32_t boxes = 10'000; boxes <= 30'000; boxes += step) {
    cases.push_back({"table1", "boxes", "", static_cast<double>(boxes),
                     makeWorkload(Table1{.boxes = boxes, .sensors = of(extent, 32, 8, 2)})});
  }
  return cases;
}

std::vector<Case> growthCases(Extent extent) {
  std::vector<Case> cases;
  const auto add = [&](const char* name, uint32_t x, Workload workload) {
    cases.push_back({"growth", name, "", static_cast<double>(x), std::move(workload)});
  };
  const uint32_t most = of(extent, 5, 3, 2), sensors = of(extent, 32, 8, 2);
  const auto first = [&](std::vector<uint32_t> values) {
    values.resize(most);
    return values;
  };
  for (const uint32_t boxes : first({1'000, 4'000, 16'000, 64'000, 256'000})) {
    add("boxes", boxes, makeWorkload(Scale{.boxes = boxes, .sensors = sensors}));
  }
  for (const uint32_t count : first({1, 8, 64, 512, 2'048})) {
    add("sensors", count, makeWorkload(Scale{.boxes = 10'000, .sensors = count, .shape = SensorShape::box}));
  }
  for (const uint32_t segments : first({8, 16, 32, 64, 128})) {
    const MeshData ring = makeTorus(1, 0.3, 2 * segments, segments);
    const uint32_t triangles = ring.triangleCount();
    add("triangles", triangles, makeWorkload(RandomPoses{.meshes = {ring}, .sensors = sensors}));
  }
  return cases;
}

}  // namespace radar::tools
