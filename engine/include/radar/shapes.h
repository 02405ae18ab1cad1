// Round shapes, exact and without tessellation: a mesh and a radius. What moves with Query::clearance r is the mesh
// rounded by a ball of radius r: all points that are no farther than r from it. So a point is a ball, a segment a
// capsule, a disc a bull-nosed cutter, a box one with round edges.
//
//   const radar::RoundShape tool = radar::ball(3);
//   const radar::MeshId mesh = scene.addMesh(tool.positions, tool.indices);
//   radar::Query query{.mesh = mesh, .direction = {0, 0, -1}, .distance = 9, .clearance = tool.radius + margin};
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "radar/error.h"

namespace radar {

struct RoundShape {
  std::vector<float> positions{};   ///< 3 per vertex, mesh units
  std::vector<uint32_t> indices{};  ///< 3 per triangle, as Scene::addMesh takes them
  /// World units, as Query::clearance: a pose that scales the mesh does not scale it.
  double radius = 0;
};

/// All three throw Error unless the radius is from 0 to 2^1000.

/// Around the origin of the mesh: a triangle whose corners are one point.
RADAR_API RoundShape ball(double radius);
/// Around the segment between two points, mesh units: a triangle with two corners at `to`. The points may be the same.
/// Throws unless they are finite.
RADAR_API RoundShape capsule(const std::array<float, 3>& from, const std::array<float, 3>& to, double radius);
/// Around the triangles of a mesh, 3 floats per vertex and 3 vertex numbers per triangle, which Scene::addMesh checks.
/// What is enclosed by them and farther than the radius from them all is not a part of it.
RADAR_API RoundShape rounded(std::span<const float> positions, std::span<const uint32_t> indices, double radius);

}  // namespace radar
