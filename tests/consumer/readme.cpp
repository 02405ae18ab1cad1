#include <radar/radar.h>
#include <cstdio>

int main() {
  radar::Scene scene;
  const float corners[] = {-1, -1, 0, 1, -1, 0, 0, 1, 0};
  const uint32_t triangle[] = {0, 1, 2};
  const radar::MeshId mesh = scene.addMesh(corners, triangle);
  scene.addObject({.mesh = mesh, .worldFromMesh = {{1, 0, 0, 0.1, 0, 1, 0, 0.2, 0, 0, 1, 5}}});

  const radar::Device device = radar::Device::open();
  radar::Sweeper sweeper(device, scene);
  const radar::Query query{.mesh = mesh, .direction = {0, 0, 1}, .distance = 10};
  const radar::Result result = sweeper.run({&query, 1}).results[0];
  if (result.status == radar::Status::hit) std::printf("touches object %u after %g\n", result.object, result.t);
}
