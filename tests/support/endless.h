// A search without an end in sight, for tests of how it is stopped.
#pragma once

#include "support/world.h"
#include "workloads/random.h"
#include "workloads/shapes.h"

namespace radar::test {

/// Two clouds of segments, through each other: their boxes overlap, and no two of them touch, so that most of a thousand
/// million pairs are looked at, in half a minute or more.
struct Endless {
  Endless() {
    tools::Random random(63);
    MeshId meshes[2];
    for (MeshId& mesh : meshes) {
      tools::MeshData cloud;
      for (int i = 0; i < 30'000; ++i) {
        const uint32_t first = cloud.vertexCount();
        addVertex(cloud, random.inCube(1));
        addVertex(cloud, random.inCube(1));
        cloud.indices.insert(cloud.indices.end(), {first, first + 1, first + 1});
      }
      mesh = add(scene, cloud);
    }
    scene.addObject({meshes[0], at(0, 0, 0), ~0u});
    query = {.mesh = meshes[1], .worldFromMesh = at(0, 0, 0), .direction = {0, 0, 1}, .distance = 0};
  }
  Scene scene;
  Query query;
};

}  // namespace radar::test
