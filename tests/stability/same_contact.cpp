#include "stability/same_contact.h"

#include <utility>

#include "workloads/random_shapes.h"
#include "workloads/shapes.h"

namespace radar::tools {

namespace {

constexpr double kGrid = 0x1p-8;

MeshData onGrid(MeshData mesh) {
  for (float& value : mesh.positions) value = static_cast<float>(std::round(value / kGrid) * kGrid);
  return mesh;
}

Vec3 wholeLength(Random& random) {
  constexpr std::array<Vec3, 6> kWhole{{{0, 0, 1}, {0, 3, 4}, {0, 5, 12}, {1, 2, 2}, {2, 3, 6}, {1, 4, 8}}};
  const Rotation rotation = random.quarterTurns();
  return turned(rotation, kWhole[random.below(kWhole.size())]);
}

MeshData cut(const MeshData& mesh, Random& random) {
  MeshData out{mesh.name, mesh.positions, {}};
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    const size_t k = random.below(3);
    const uint32_t a = mesh.indices[i + k], b = mesh.indices[i + (k + 1) % 3], c = mesh.indices[i + (k + 2) % 3];
    if (random.oneIn(2)) {
      out.indices.insert(out.indices.end(), {a, b, c});
      continue;
    }
    const uint32_t middle = out.vertexCount();
    for (size_t axis = 0; axis < 3; ++axis) {
      out.positions.push_back(0.5f * (out.positions[3 * b + axis] + out.positions[3 * c + axis]));
    }
    out.indices.insert(out.indices.end(), {a, b, middle, a, middle, c});
  }
  return out;
}

}  // namespace

HardCase dyadicCase(Random& random) {
  HardCase hard;
  const auto placed = [&](const Vec3& where) {
    MeshData mesh = onGrid(anyShape(random));
    const double size = random.oneIn(3) ? 2 : random.oneIn(2) ? 0.5 : 1;
    const Rotation rotation = random.quarterTurns();
    return PlacedMesh{std::move(mesh), makePose(rotation, {size, size, size}, where)};
  };
  hard.direction = wholeLength(random);
  const double steps = random.below(96);
  const Vec3 aside = 0.25 * random.wholeVector(6);
  const Vec3 where = (0.0625 * steps) * hard.direction + aside;
  hard.sensor = placed({});
  hard.objects.push_back(placed(where));
  hard.distance = 0.0625 * lengthOf(hard.direction) * (steps + random.below(48));
  return hard;
}

HardCase movedTogether(const HardCase& hard, Random& random) {
  HardCase out = hard;
  const Vec3 offset = 0.25 * random.wholeVector(1000);
  if (random.oneIn(2)) {
    place(out, random.quarterTurns(), offset);
    return out;
  }
  // In the vertices: each pose turns the offset back before, so that the world moves alike.
  const auto bakeBack = [&](PlacedMesh& placed) {
    moveVertices(placed, offset);
    moveBy(placed.worldFromMesh, offset - turned(linearPart(placed.worldFromMesh), offset));
  };
  bakeBack(out.sensor);
  for (PlacedMesh& object : out.objects) bakeBack(object);
  return out;
}

HardCase changedPlaces(const HardCase& hard) {
  HardCase out = hard;
  std::swap(out.sensor, out.objects.at(0));
  out.direction = -1 * out.direction;
  return out;
}

HardCase cutInTwo(const HardCase& hard, Random& random) {
  HardCase out = hard;
  out.sensor.mesh = cut(hard.sensor.mesh, random);
  for (PlacedMesh& object : out.objects) object.mesh = cut(object.mesh, random);
  return out;
}

HardCase withFarObjects(const HardCase& hard, Random& random) {
  HardCase out = hard;
  const double beyond = 1000 + 2 * hard.distance;
  for (uint32_t i = 1 + random.below(5); i > 0; --i) {
    const Vec3 where = beyond * random.direction();
    out.objects.push_back({anyShape(random), placedAt(where)});
  }
  return out;
}

std::array<HardCase, 2> splitWay(const HardCase& hard, Random& random) {
  const double length = lengthOf(hard.direction);
  const auto steps = static_cast<uint32_t>(hard.distance / (0.0625 * length));
  const double part = 0.0625 * random.below(steps + 1);
  std::array<HardCase, 2> parts{hard, hard};
  parts[0].distance = part * length;
  parts[1].distance = hard.distance - parts[0].distance;
  moveBy(parts[1].sensor.worldFromMesh, part * hard.direction);
  return parts;
}

}  // namespace radar::tools
