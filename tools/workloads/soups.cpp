#include "workloads/generate.h"

namespace radar::tools {

const char* nameOf(Soup soup) {
  constexpr std::array<const char*, kSoups.size()> kNames{"plain", "needles", "degenerate", "lattice", "tiny", "far"};
  return kNames[static_cast<size_t>(soup)];
}

MeshData makeSoup(Soup soup, uint32_t triangles, Random& random) {
  MeshData mesh{std::string("soup-") + nameOf(soup), {}, {}};
  for (uint32_t i = 0; i < triangles; ++i) {
    const Vec3 middle = random.inCube(1);
    std::array<Vec3, 3> corners;
    for (Vec3& corner : corners) corner = middle + 0.2 * random.inCube(1);
    if (soup == Soup::needles) corners[2] = corners[0] + 1e-6 * (corners[2] - middle);
    if (soup == Soup::degenerate) {
      const uint32_t kind = random.below(4);  // 0: a triangle
      const double along = random.uniform(-0.5, 1.5);
      if (kind == 1) corners[1] = corners[2] = corners[0];
      if (kind == 2) corners[2] = corners[0] + along * (corners[1] - corners[0]);
      if (kind == 3) corners[2] = corners[1];
    }
    for (Vec3& corner : corners) {
      for (double& value : corner) {
        if (soup == Soup::lattice) value = std::floor(4 * value + 0.5) / 4;
        if (soup == Soup::tiny) value *= 1e-6;
        if (soup == Soup::far) value += 2000;
      }
      addVertex(mesh, corner);
    }
    mesh.indices.insert(mesh.indices.end(), {3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

Transform normalised(Soup soup, const Transform& pose) {
  Transform result = pose;
  for (size_t row = 0; row < 3; ++row) {
    double* r = &result.m[4 * row];
    if (soup == Soup::tiny) {
      for (size_t k = 0; k < 3; ++k) r[k] *= 1e6;
    }
    if (soup == Soup::far) r[3] -= 2000 * (r[0] + r[1] + r[2]);
  }
  return result;
}

Workload makeWorkload(const Soups& options) {
  Workload workload;
  Random random(options.seed);
  constexpr auto kKinds = static_cast<uint32_t>(kSoups.size());
  for (const Soup soup : kSoups) workload.meshes.push_back(makeSoup(soup, options.triangles, random));
  const auto instance = [&](uint32_t i, double reach) {
    const Vec3 where = random.inCube(reach) + options.origin * kFull;
    return Instance{i % kKinds, normalised(kSoups[i % kKinds], random.affine(where))};
  };
  workload.scenes.push_back({"soup", {}, {}, {}});
  for (uint32_t i = 0; i < options.objects; ++i) workload.scenes[0].instances.push_back(instance(i, 8));
  for (uint32_t i = 0; i < options.sensors; ++i) {
    QuerySpec query;
    query.id = "sensor/" + std::to_string(i);
    // Sensors and objects of all kKinds meet, not only those of one kind.
    query.setSensor(instance(i + i / kKinds, 10));
    const Vec3 direction = random.direction();
    query.direction = random.uniform(0.01, 100) * direction;
    query.distance = random.uniform(0, 12);
    workload.queries.push_back(std::move(query));
  }
  return workload;
}

}  // namespace radar::tools
