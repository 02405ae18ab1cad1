// Each random number is drawn in a statement of its own, since the compiler chooses the order in which it evaluates
// arguments.
#include "workloads/rest_families.h"

#include <utility>

#include "workloads/shapes.h"
#include "workloads/voxels.h"

namespace radar::tools {

namespace {

using Bodies = std::vector<PlacedMesh>;

MeshData moved(const MeshData& mesh, const Vec3& offset) {
  MeshData out{mesh.name, {}, {}};
  append(out, mesh, offset);
  return out;
}

MeshData boxBetween(const Vec3& low, const Vec3& high) {
  return moved(makeBox(high - low), 0.5 * (low + high));
}

/// The mesh where it is, in a frame turned by quarters, scaled by a power of two, perhaps mirrored, and up to `reach`
/// whole steps away. Coordinates must stay exact in float.
PlacedMesh inOwnFrame(MeshData mesh, uint32_t reach, Random& random) {
  const Rotation turn = random.quarterTurns();
  const double scale = 0.5 * (1 << random.below(3));
  const bool isMirrored = random.oneIn(3);
  const Vec3 origin = random.wholeVector(reach);
  const Vec3 scales{isMirrored ? -scale : scale, scale, scale};
  for (size_t i = 0; i < mesh.positions.size(); i += 3) {
    float* p = &mesh.positions[i];
    const Vec3 from = Vec3{p[0], p[1], p[2]} - origin;
    for (size_t k = 0; k < 3; ++k) {
      const double along = turn[k] * from[0] + turn[3 + k] * from[1] + turn[6 + k] * from[2];
      p[k] = static_cast<float>(along / scales[k]);
    }
  }
  for (size_t i = 0; isMirrored && i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i], mesh.indices[i + 1]);
  return {std::move(mesh), makePose(turn, scales, origin)};
}

Vec3 wholeDirection(Random& random) {
  const uint32_t most = random.below(3);
  const Vec3 direction = most == 0 ? random.axis() : random.wholeVector(most);
  return direction == Vec3{} ? Vec3{1, -1, 2} : direction;
}

/// A case in which one of the bodies moves. In half of them it is one of the objects as well, and excluded. In a third
/// it starts some steps behind.
HardCase amongOthers(Bodies bodies, size_t sensor, const Vec3& direction, Random& random) {
  HardCase hard;
  hard.sensor = bodies[sensor];
  if (random.oneIn(2)) {
    hard.exclude = {static_cast<uint32_t>(sensor)};
  } else {
    bodies.erase(bodies.begin() + static_cast<std::ptrdiff_t>(sensor));
  }
  hard.objects = std::move(bodies);
  hard.direction = direction;
  if (random.oneIn(3)) moveBy(hard.sensor.worldFromMesh, -0.5 * (1 + random.below(8)) * direction);
  if (random.oneIn(5)) {
    const double off = random.magnitude(-12, -1);
    hard.direction = hard.direction + off * random.direction();
  }
  hard.distance = random.oneIn(3) ? 0.5 * random.below(8) : random.uniform(0, 12);
  return hard;
}

void placeAtRest(HardCase& hard, double how, Random& random) {
  if (random.oneIn(how < 2 ? 2 : 5)) hard.slack = 0;
  if (how == 0) return;
  if (how == 1) {
    const Rotation frame = random.quarterTurns();
    return place(hard, frame, random.wholeVector(8));
  }
  const Rotation frame = random.rotation();
  place(hard, frame, random.inCube(6));
  if (how == 2) return;
  resize(hard, random.magnitude(-3, 3));
  const double far = random.magnitude(0, 6);
  place(hard, kUpright, far * random.direction());
}

HardCase assembly(Random& random) {
  const uint32_t side = 2 + random.below(3), count = 2 + random.below(4);
  Bodies bodies;
  for (const Solid& solid : packedSolids(side, count, random)) {
    MeshData mesh = boundaryOf(solid, random);
    bodies.push_back(inOwnFrame(std::move(mesh), 4, random));
  }
  return amongOthers(std::move(bodies), 0, wholeDirection(random), random);
}

HardCase stacked(Random& random) {
  Vec3 size;
  for (double& side : size) side = 0.25 * (1 + random.below(8));
  const MeshData box = makeBox(size);
  std::array<uint32_t, 3> counts;
  for (uint32_t& count : counts) count = 1 + random.below(3);
  Bodies bodies;
  for (uint32_t i = 0; i < counts[0] * counts[1] * counts[2]; ++i) {
    if (!bodies.empty() && random.oneIn(3)) continue;
    const std::array<uint32_t, 3> cell{i % counts[0], i / counts[0] % counts[1], i / counts[0] / counts[1]};
    const Vec3 where{cell[0] * size[0], cell[1] * size[1], cell[2] * size[2]};
    bodies.push_back(inOwnFrame(moved(box, where), 4, random));
  }
  const uint32_t sensor = random.below(static_cast<uint32_t>(bodies.size()));
  return amongOthers(std::move(bodies), sensor, wholeDirection(random), random);
}

HardCase corner(Random& random) {
  Bodies bodies;
  const auto add = [&](const MeshData& mesh) { bodies.push_back(inOwnFrame(mesh, 4, random)); };
  const auto addBox = [&](const Vec3& low, const Vec3& high) { add(boxBetween(low, high)); };
  const auto joint = [&] { return 0.5 * random.below(5); };  // where two bodies in one plane meet
  const Solid shapes[]{{{0, 0, 0}}, {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  const uint32_t shape = random.below(4);
  if (shape == 3) {
    addBox({0, 0, 0}, {1, 1, 1});
  } else {
    add(boundaryOf(shapes[shape], random));
  }
  const double tile = joint();
  addBox({-4, -4, -1}, {tile, 4, 0});
  addBox({tile, -4, -1}, {8, 4, 0});
  if (random.oneIn(2)) {  // two walls in one plane
    const double height = joint() + 0.25;
    addBox({-1, -4, 0}, {0, 4, height});
    addBox({-1, -4, height}, {0, 4, 4});
  }
  if (random.oneIn(3)) addBox({-4, -1, 0}, {8, 0, 4});
  if (random.oneIn(3)) addBox({1, 1, -2}, {2, 2, 4});  // touched along an edge
  const double above = shape == 1 ? 2 : 1;
  if (random.oneIn(3)) addBox({-4, -4, above + joint()}, {8, 4, 5});
  if (random.oneIn(2)) addBox({3, -4, 0}, {4, 4, 0.25 + joint()});
  if (random.oneIn(2)) addBox({-4, 3, 0}, {8, 4, 4});
  Vec3 direction = wholeDirection(random);
  if (!random.oneIn(4)) direction = {std::abs(direction[0]), std::abs(direction[1]), std::abs(direction[2])};
  return amongOthers(std::move(bodies), 0, direction, random);
}

HardCase peg(Random& random) {
  const uint32_t sides = 3 + random.below(6);
  const double radius = 0.5 * (1 + random.below(3)), length = 0.5 * (1 + random.below(6));
  const double up = 0.25 * random.below(5);
  const std::array<std::array<double, 2>, 4> profile{
      {{radius, -0.5}, {radius + 1, -0.5}, {radius + 1, 0.5}, {radius, 0.5}}};
  const MeshData ring = named("ring", makeLathe(profile, true, sides));
  // Their vertices are no whole numbers, so their frames keep the origin.
  Bodies bodies;
  const auto add = [&](const MeshData& mesh) { bodies.push_back(inOwnFrame(mesh, 0, random)); };
  const double low = up - 0.5 * length, high = up + 0.5 * length;
  const auto addRod = [&](double from, double to) {
    add(moved(makeRod(radius, to - from, sides), {0, 0, 0.5 * (from + to)}));
  };
  addRod(low, high);
  add(ring);
  if (random.oneIn(3)) add(moved(ring, {0, 0, 1}));
  if (random.oneIn(3)) addRod(low - 1, low);
  if (random.oneIn(3)) addRod(high + 1, high + 2);
  const uint32_t sensor = random.oneIn(4) ? 1 : 0;
  const Vec3 direction = random.oneIn(4) ? wholeDirection(random) : Vec3{0, 0, random.oneIn(2) ? 1.0 : -1.0};
  return amongOthers(std::move(bodies), sensor, direction, random);
}

HardCase placedCase(HardCase hard, double how, Random& random) {
  placeAtRest(hard, how, random);
  return hard;
}

}  // namespace

HardCase assemblyCase(double how, Random& random) {
  return placedCase(assembly(random), how, random);
}

HardCase stackedCase(double how, Random& random) {
  return placedCase(stacked(random), how, random);
}

HardCase cornerCase(double how, Random& random) {
  return placedCase(corner(random), how, random);
}

HardCase pegCase(double how, Random& random) {
  return placedCase(peg(random), how, random);
}

HardCase sunkCase(double depth, Random& random) {
  const uint32_t kind = random.below(4);
  HardCase hard = kind == 0 ? assembly(random) : kind == 1 ? stacked(random) : kind == 2 ? corner(random) : peg(random);
  for (PlacedMesh& object : hard.objects) {
    const Vec3 direction = random.oneIn(2) ? random.axis() : random.direction();
    if (random.oneIn(2)) moveBy(object.worldFromMesh, depth * direction);
  }
  return placedCase(std::move(hard), random.below(3), random);
}

}  // namespace radar::tools
