#include "measure/clearances.h"

#include <cmath>

#include "measure/single.h"
#include "radar/cpu_sweeper.h"
#include "workloads/drop_cutter.h"
#include "workloads/generate.h"
#include "workloads/random.h"
#include "workloads/shapes.h"

namespace radar::tools {

namespace {

/// Times each query alone.
void ask(const std::string& workload, const Scene& scene, std::span<const Query> queries, Json& report) {
  CpuSweeper sweeper(scene, 1);
  Answers answers;
  size_t touching = 0;
  for (const Result& result : sweeper.run(queries).results) touching += result.status != Status::clear;
  const Ask alone = [&](const Query& query) { sweeper.run({&query, 1}, answers); };
  Json row{{"workload", workload}};
  row.update(latencies(secondsAlone(queries, {&alone, 1}).front()));
  row["touching"] = touching;
  partOf(report, "clearances", "Section clearances, microseconds a query, one thread")["rows"].push_back(row);
}

MeshId add(Scene& scene, const MeshData& mesh) {
  return scene.addMesh(mesh.positions, mesh.indices);
}

/// Round about z, in z = 0.
MeshData makeDisc(double radius, uint32_t corners) {
  MeshData disc;
  disc.positions = {0, 0, 0};
  for (uint32_t i = 0; i < corners; ++i) {
    const double turn = 2 * std::acos(-1.0) * i / corners;
    disc.positions.push_back(static_cast<float>(radius * std::cos(turn)));
    disc.positions.push_back(static_cast<float>(radius * std::sin(turn)));
    disc.positions.push_back(0);
    disc.indices.insert(disc.indices.end(), {0, i + 1, (i + 1) % corners + 1});
  }
  return disc;
}

void dropCutters(Extent extent, Json& report) {
  const uint32_t side = extent == Extent::full ? 60 : 4;
  const Workload workload = makeWorkload(DropCutter{.columns = side, .rows = side});
  Scene scene;
  scene.addObject({add(scene, workload.meshes[1]), {}});
  const auto drop = [&](const std::string& name, const MeshData& mesh, double clearance) {
    const MeshId id = add(scene, mesh);
    std::vector<Query> queries;
    for (const QuerySpec& place : workload.queries) {
      const std::array<double, 12>& m = place.worldFromMesh.m;
      Query query{.mesh = id, .worldFromMesh = placedAt({m[3], m[7], m[11]}), .direction = place.direction};
      query.distance = place.distance;
      query.clearance = clearance;
      queries.push_back(query);
    }
    ask(name, scene, queries, report);
  };
  MeshData point;
  point.positions.resize(9);
  point.indices = {0, 1, 2};
  for (const double radius : {0.6, 3.0, 10.0}) drop("ball of radius " + print("%g", radius), point, radius);
  constexpr uint32_t kCorners = 64;
  drop("bull nose of radius 3, its edge of 1", makeDisc(2, kCorners), 1);
  drop("flat cutter of radius 3", makeDisc(3, kCorners), 0);
}

/// Of one size, from afar past 20 objects, towards one of them.
void flyPast(const std::string& name, const MeshData& mesh, Extent extent, Json& report) {
  Scene scene;
  const MeshId id = add(scene, mesh);
  Random random(1);
  double size = 0;
  for (const float x : mesh.positions) size = std::max(size, 2.0 * std::abs(x));
  std::vector<Vec3> places;
  for (int i = 0; i < 20; ++i) {
    places.push_back(random.inCube(4 * size));
    scene.addObject({id, makePose(random.rotation(), {1, 1, 1}, places.back())});
  }
  for (const bool hasClearance : {false, true}) {
    std::vector<Query> queries;
    for (uint32_t i = 0; i < (extent == Extent::full ? 10'000u : 32u); ++i) {
      const Vec3 from = random.inCube(8 * size);
      Query query{.mesh = id, .worldFromMesh = makePose(random.rotation(), {1, 1, 1}, from)};
      query.direction = places[i % places.size()] + random.inCube(0.5 * size) - from;
      query.distance = 20 * size;
      if (hasClearance) query.clearance = size * std::pow(10, random.uniform(-4, 0));
      queries.push_back(query);
    }
    ask(name + (hasClearance ? ", with clearances" : ""), scene, queries, report);
  }
}

/// Table 1's sensors: their first contact, and the closest approach and the last contact beside it.
void askWholeWay(const std::string& name, SensorShape shape, Extent extent, Json& report) {
  const bool isFull = extent == Extent::full;
  const Workload workload =
      makeWorkload(Table1{.boxes = isFull ? 30'000u : 300u, .sensors = isFull ? 3'000u : 16u, .shape = shape});
  Scene scene;
  replaceBy(workload, 0, scene);
  std::vector<Query> queries = queriesOf(workload.queries);
  const auto askAll = [&](const char* what, bool closest, bool exit) {
    for (Query& query : queries) {
      query.closest = closest;
      query.exit = exit;
    }
    ask(name + what, scene, queries, report);
  };
  askAll("", false, false);
  askAll(", with closest", true, false);
  askAll(", with exit", false, true);
}

}  // namespace

void measureClearances(Extent extent, Json& report) {
  dropCutters(extent, report);
  flyPast("teapots", makeTeapot(), extent, report);
  flyPast("rings", makeTorus(1, 0.4, 60, 30), extent, report);
  askWholeWay("Table 1's boxes", SensorShape::box, extent, report);
  askWholeWay("Table 1's teapots", SensorShape::teapot, extent, report);
  partOf(report, "clearances")["state"] = "done";
}

}  // namespace radar::tools
