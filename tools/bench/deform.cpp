// A mesh that deforms at every step, and a batch of 64 about it: its tree refitted or built anew.
#include <cmath>
#include <memory>

#include "bench/benchmarks.h"
#include "radar/cpu_sweeper.h"
#include "workloads/random.h"
#include "workloads/shapes.h"

namespace radar::bench {

namespace {

/// A sphere, and the same with waves of two shapes.
struct Waves {
  Waves() : sphere(tools::makeUvSphere(225, 224)), shapes{sphere.positions, sphere.positions} {
    for (size_t i = 0; i < sphere.positions.size(); i += 3) {
      for (int shape = 0; shape < 2; ++shape) {
        const double wave = 1 + 0.05 * std::sin(9.0 * sphere.positions[i] + 7.0 * sphere.positions[i + 1] + shape);
        for (size_t k = i; k < i + 3; ++k) shapes[shape][k] = static_cast<float>(wave * sphere.positions[k]);
      }
    }
  }
  tools::MeshData sphere;
  std::vector<float> shapes[2];
};

/// A scene with the mesh.
struct Sea {
  explicit Sea(const Waves& all) : waves(all) {
    const tools::MeshData box = tools::makeBox({0.05, 0.05, 0.05});
    sensor = scene.addMesh(box.positions, box.indices);
    add();
  }
  void add() {
    mesh = scene.addMesh(waves.shapes[0], waves.sphere.indices);
    object = scene.addObject({.mesh = mesh});
  }
  void refit() { scene.setPositions(mesh, waves.shapes[++step % 2]); }
  void rebuild() {
    scene.removeObject(object);
    scene.removeMesh(mesh);
    mesh = scene.addMesh(waves.shapes[++step % 2], waves.sphere.indices);
    object = scene.addObject({.mesh = mesh});
  }

  const Waves& waves;
  Scene scene;
  MeshId sensor = kNone, mesh = kNone;
  ObjectId object = kNone;
  size_t step = 0;
};

std::vector<Query> queriesOf(MeshId sensor) {
  tools::Random random(1);
  std::vector<Query> queries(64);
  for (Query& query : queries) {
    const tools::Vec3 from = random.direction(), to = random.inCube(0.5);
    query = {.mesh = sensor, .worldFromMesh = {{1, 0, 0, 3 * from[0], 0, 1, 0, 3 * from[1], 0, 0, 1, 3 * from[2]}}};
    for (size_t k = 0; k < 3; ++k) query.direction[k] = to[k] - 3 * from[k];
    query.distance = 4;
  }
  return queries;
}

void run(int& status) {
  const Device device = Device::open();
  printHead({&device, 1});
  const Waves waves;
  Sea refitted(waves), rebuilt(waves), onDevice(waves);
  CpuSweeper cpu(refitted.scene), cpuRebuilt(rebuilt.scene);
  Sweeper sweeper(device, onDevice.scene, {.cpuBatch = 0});
  std::vector<Method> methods{{"CPU, tree refitted", [&](auto queries) { return cpu.run(queries).results; },
                               [&](uint32_t) {
                                 refitted.refit();
                                 cpu.sync();
                               }},
                              {"CPU, tree built anew", [&](auto queries) { return cpuRebuilt.run(queries).results; },
                               [&](uint32_t) {
                                 rebuilt.rebuild();
                                 cpuRebuilt.sync();
                               }},
                              {"device, tree refitted", [&](auto queries) { return sweeper.run(queries).results; },
                               [&](uint32_t) {
                                 onDevice.refit();
                                 sweeper.sync();
                               }}};
  const Batch batch{.queries = queriesOf(refitted.sensor)};
  printRows("deform", methods, {&batch, 1}, {.least = 15, .most = 15}, status);
}

}  // namespace

void addDeform(CLI::App& app, int& status) {
  CLI::App* command =
      app.add_subcommand("deform", "A batch of 64 after a mesh of 100,352 triangles has deformed: prepare is its tree");
  command->callback([&status] { run(status); });
}

}  // namespace radar::bench
