#include "workloads/interlocking.h"

#include "workloads/random_shapes.h"
#include "workloads/shapes.h"

namespace radar::tools {

namespace {

// A sheet of strips along x, cut with gaps as wide as they are: two triangles each.
MeshData makeGrating(uint32_t strips, double length, double pitch) {
  MeshData mesh{"grating", {}, {}};
  for (uint32_t i = 0; i < strips; ++i) {
    const double low = pitch * (i - 0.5 * strips);
    for (const double x : {-0.5 * length, 0.5 * length}) {
      for (const double y : {low, low + 0.5 * pitch}) addVertex(mesh, {x, y, 0});
    }
    for (const uint32_t corner : {0u, 1u, 2u, 1u, 3u, 2u}) mesh.indices.push_back(4 * i + corner);
  }
  return mesh;
}

// A comb of round teeth with room between them for another's.
MeshData makeRoundComb(uint32_t teeth) {
  MeshData mesh = named("round comb", makeBox({0.5 * teeth, 0.3, 0.3}));
  for (uint32_t i = 0; i < teeth; ++i) {
    append(mesh, makeRod(0.075, 3, 64), {0.5 * (i + 0.5) - 0.25 * teeth, 0, 1.65});
  }
  return mesh;
}

/// While the first mesh is at the origin, it is mostly free to move along +z.
Interlocked shapesOf(Interlocking kind) {
  constexpr Rotation kReversed{1, 0, 0, 0, -1, 0, 0, 0, -1}, kTurned{0.28, -0.96, 0, 0.96, 0.28, 0, 0, 0, 1};
  constexpr Rotation kSlightly{0.9998, 0, 0.02, 0, 1, 0, -0.02, 0, 0.9998};
  constexpr Rotation kTilted{0.9968, 0, 0.08, 0, 1, 0, -0.08, 0, 0.9968};
  switch (kind) {
    case Interlocking::ringOnPeg:
      return {makeTorus(1, 0.25, 96, 32), makeRod(0.65, 8, 256), kUpright, {0, 0, 0.3}};
    case Interlocking::combInComb:
      return {makeRoundComb(8), makeRoundComb(8), product(kSlightly, kReversed), {0.25, 0.02, 4.4}};
    default:
      return {makeGrating(256, 8, 0.03), makeGrating(256, 8, 0.03), product(kTilted, kTurned), {0, 0, 0.6}};
  }
}

}  // namespace

const char* nameOf(Interlocking kind) {
  constexpr std::array<const char*, kInterlocking.size()> kNames{"ring-on-peg", "comb-in-comb", "crossing"};
  return kNames[static_cast<size_t>(kind)];
}

Workload makeWorkload(const InterlockingPairs& options) {
  Random random(options.seed);
  Interlocked shapes = shapesOf(options.kind);
  Workload workload;
  workload.scenes.push_back({nameOf(options.kind), {}, {}, {}});
  for (uint32_t i = 0; i < options.sensors; ++i) {
    const Vec3 home{100.0 * i, 0, 0};
    const Rotation frame = random.rotation();
    const Vec3 second = turned(frame, shapes.offset) + home;
    workload.scenes[0].instances.push_back({1, makePose(product(frame, shapes.rotation), kFull, second)});
    const Vec3 towards = random.inCube(0.3) + Vec3{0, 0, 1};
    QuerySpec query;
    query.id = std::to_string(i);
    query.setSensor({0, makePose(frame, kFull, home)});
    query.direction = turned(frame, towards);
    query.distance = random.uniform(1, 8);
    workload.queries.push_back(std::move(query));
  }
  workload.meshes = {std::move(shapes.first), std::move(shapes.second)};
  return workload;
}

}  // namespace radar::tools
