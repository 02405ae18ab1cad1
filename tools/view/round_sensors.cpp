#include "view/round_sensors.h"

#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>

#include "workloads/shapes.h"
#include "workloads/vectors.h"

namespace radar::tools {

namespace {

constexpr uint32_t kSegments = 24, kRings = 6;  // of a half
constexpr double kMostDrawn = 1e30;             // floats hold it

/// The two ends of a mesh that is a point or a segment with these corners, mesh units; else none.
std::optional<std::array<const float*, 2>> endsOf(const std::vector<float>& positions, const MeshData& mesh) {
  const auto at = [&](size_t i) { return &positions[3 * size_t{mesh.indices[i]}]; };
  const auto isAt = [](const float* a, const float* b) { return a[0] == b[0] && a[1] == b[1] && a[2] == b[2]; };
  const float *first = at(0), *second = first;
  for (size_t i = 0; i < mesh.indices.size(); ++i) {
    if (isAt(at(i), first) || isAt(at(i), second)) continue;
    if (second != first) return std::nullopt;
    second = at(i);
  }
  return std::array{first, second};
}

/// From the origin along z.
MeshData capsuleOf(double length, double radius) {
  std::vector<std::array<double, 2>> profile;
  for (uint32_t half = 0; half < 2; ++half) {
    for (uint32_t ring = half == 1 && length == 0; ring <= kRings; ++ring) {
      const double angle = std::numbers::pi / 2 * (double(ring) / kRings - (half == 0));
      const bool isPole = ring == (half == 0 ? 0 : kRings);
      profile.push_back({isPole ? 0 : radius * std::cos(angle), half * length + radius * std::sin(angle)});
    }
  }
  return makeLathe(profile, false, kSegments);
}

/// Rigid, with the z axis from one point to another, where they differ.
Transform alongFrom(const Vec3& from, const Vec3& to) {
  const double length = lengthOf(to - from);
  const Vec3 z = length > 0 ? 1 / length * (to - from) : Vec3{0, 0, 1};
  // By T. Duff et al., "Building an orthonormal basis, revisited", 2017.
  const double sign = std::copysign(1, z[2]), a = -1 / (sign + z[2]), b = z[0] * z[1] * a;
  const Vec3 x{1 + sign * z[0] * z[0] * a, sign * b, -sign * z[0]}, y{b, sign + z[1] * z[1] * a, -z[1]};
  return {{x[0], y[0], z[0], from[0], x[1], y[1], z[1], from[1], x[2], y[2], z[2], from[2]}};
}

}  // namespace

RoundSensors::RoundSensors(const Workload& workload, std::span<const QuerySpec> queries) {
  std::map<std::tuple<uint32_t, float, double>, uint32_t> made;  // by mesh, length and radius
  for (const QuerySpec& query : queries) {
    sensors.push_back(query.sensor());
    if (query.chain) continue;
    const MeshData& mesh = workload.meshes[query.mesh];
    const double radius = mesh.radius > 0 ? mesh.radius : query.clearance;
    if (!(radius > 0 && radius < kMostDrawn)) continue;
    const std::vector<float>* positions = &mesh.positions;
    for (const Deformation& deformed : workload.scenes[query.scene].deforms) {
      if (deformed.mesh == query.mesh) positions = &deformed.positions;
    }
    const auto ends = endsOf(*positions, mesh);
    if (!ends) continue;
    const Vec3 from = transformPoint(query.worldFromMesh, (*ends)[0]),
               to = transformPoint(query.worldFromMesh, (*ends)[1]);
    const double length = lengthOf(to - from);
    if (!(length < kMostDrawn)) continue;
    const auto [found, isNew] =
        made.emplace(std::tuple(query.mesh, float(length), radius), uint32_t(workload.meshes.size() + meshes.size()));
    if (isNew) {
      meshes.push_back(capsuleOf(length, radius));
      meshes.back().name = mesh.name;
      meshes.back().radius = mesh.radius;
    }
    sensors.back() = {found->second, alongFrom(from, to)};
  }
}

}  // namespace radar::tools
