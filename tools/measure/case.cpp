#include "measure/case.h"

#include <algorithm>
#include <cmath>

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
Workload familyScenes(const std::vector<const char*>& families, Extent extent, Company company) {
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
  const auto add = [&](const char* name, const std::string& about, std::function<Workload()> make) {
    cases.push_back({.section = "front", .workload = name, .about = about, .make = std::move(make)});
  };
  const auto addFamilies = [&](const char* name, const char* about, const std::vector<const char*>& families,
                               Company company) {
    add(name, about, [=] { return familyScenes(families, extent, company); });
  };
  const std::string among = " among " + std::to_string(boxes) + " boxes (the paper's Table 1)";
  add("table1-teapots", "Teapots of 6,320 triangles" + among,
      [=] { return makeWorkload(Table1{.boxes = boxes, .sensors = sensors}); });
  add("table1-boxes", "Boxes" + among,
      [=] { return makeWorkload(Table1{.boxes = boxes, .sensors = sensors, .shape = SensorShape::box}); });
  add("figure7", std::to_string(teapots) + " teapots fly among 2,000 boxes (the paper's Figure 7)",
      [=] { return makeWorkload(Figure7{.teapots = teapots, .steps = of(extent, 4, 2, 1)}); });
  addFamilies("convex", "Convex shapes: boxes, balls, rods and plates", {"convex"}, Company::mixed);
  addFamilies("non-convex", "Non-convex shapes: teapots, rings, hooks, combs and cups", {"non-convex"}, Company::mixed);
  addFamilies("interlocking", "Interlocking shapes: ring on peg, hook behind bar, key in keyhole", {"interlocking"},
              Company::isolated);
  addFamilies("thin", "Thin and open shapes: sheets, open cylinders, plates and rods along and just off the axes",
              {"open", "direction"}, Company::mixed);
  addFamilies("grazing", "Grazing: needles, plates edge-on, faces along the motion, near misses and near hits",
              {"thin", "edge-on", "slope", "near"}, Company::isolated);
  return cases;
}

Case meshesCase(Extent extent, std::vector<MeshData> meshes) {
  std::string about = "Real meshes in random poses:";
  for (const MeshData& mesh : meshes) {
    about += (&mesh == &meshes.front() ? " " : ", ") + mesh.name + " (" + std::to_string(mesh.triangleCount()) + ")";
  }
  return {.section = "front", .workload = "meshes", .about = about + " triangles", .make = [extent, meshes] {
            return makeWorkload(RandomPoses{.meshes = meshes, .sensors = of(extent, 64, 16, 4)});
          }};
}

std::vector<Case> table1Cases(Extent extent) {
  std::vector<Case> cases;
  const uint32_t step = of(extent, 2'000, 10'000, 20'000);
  for (uint32_t boxes = 10'000; boxes <= 30'000; boxes += step) {
    cases.push_back({"table1", "table1", "The paper's Table 1: teapots among boxes", "boxes",
                     static_cast<double>(boxes),
                     [=] { return makeWorkload(Table1{.boxes = boxes, .sensors = of(extent, 32, 8, 2)}); }});
  }
  return cases;
}

std::vector<Case> growthCases(Extent extent) {
  std::vector<Case> cases;
  const auto add = [&](const char* name, const char* about, const char* axis, std::vector<uint32_t> values,
                       const std::function<Workload(uint32_t)>& make) {
    values.resize(of(extent, 5, 3, 2));
    for (const uint32_t x : values) {
      cases.push_back({"growth", name, about, axis, static_cast<double>(x), [=] { return make(x); }});
    }
  };
  const uint32_t sensors = of(extent, 32, 8, 2);
  add("growth-boxes", "More of the scene: teapots among boxes at one density", "boxes",
      {1'000, 4'000, 16'000, 64'000, 256'000},
      [=](uint32_t boxes) { return makeWorkload(Scale{.boxes = boxes, .sensors = sensors}); });
  add("growth-sensors", "Larger batches: boxes among 10,000 boxes", "sensors in the batch", {1, 8, 64, 512, 2'048},
      [](uint32_t count) { return makeWorkload(Scale{.boxes = 10'000, .sensors = count, .shape = SensorShape::box}); });
  // Rings of 4 s^2 triangles.
  add("growth-triangles", "Finer meshes: rings among 200 rings", "triangles of each mesh",
      {256, 1'024, 4'096, 16'384, 65'536}, [=](uint32_t triangles) {
        const auto segments = static_cast<uint32_t>(std::lround(std::sqrt(triangles / 4)));
        return makeWorkload(RandomPoses{.meshes = {makeTorus(1, 0.3, 2 * segments, segments)}, .sensors = sensors});
      });
  return cases;
}

}  // namespace radar::tools
