// Meshes made by rule. Sizes are in the mesh's own units; the same arguments give the same bits on every platform.
#pragma once

#include <functional>
#include <span>

#include "workloads/random.h"
#include "workloads/workload.h"

namespace radar::tools {

/// Centred at the origin, edge lengths `size`: 12 triangles.
MeshData makeBox(const Vec3& size);

/// A profile of {radius, height} points turned around the z axis in `segments` steps. Points of radius 0 are poles; a
/// closed profile joins its last point to its first. No degenerate triangle is made.
MeshData makeLathe(std::span<const std::array<double, 2>> profile, bool closed, uint32_t segments);

/// Radius 1, poles on z.
MeshData makeUvSphere(uint32_t rings, uint32_t segments);
/// A ring around z: the tube of radius `tube` has its centre at `radius`.
MeshData makeTorus(double radius, double tube, uint32_t segments, uint32_t tubeSegments);
/// A closed cylinder along z, centred: a rod or a peg.
MeshData makeRod(double radius, double length, uint32_t segments);
/// A cup that opens towards +z and stands on z = 0.
MeshData makeCup(double radius, double height, double wall, uint32_t segments);
/// A box thin along z.
MeshData makePlate(double width, double depth, double thickness);
/// A back along x with `teeth` teeth towards +z; teeth and gaps are `pitch` / 2 wide.
MeshData makeComb(uint32_t teeth, double pitch, double toothLength, double thickness);
/// A shank along z, bent towards +x and up again at the tip, of square section `thickness`.
MeshData makeHook(double length, double reach, double tip, double thickness);
/// How the squares of a grid are cut in two.
enum class Diagonal { rising, falling };
/// cells x cells squares of two triangles; `vertex(column, row)` gives their corners, row by row.
MeshData makeGrid(uint32_t cells, Diagonal diagonal, const std::function<Vec3(uint32_t, uint32_t)>& vertex);
/// A grid over -1..1 across z, its vertices up to `roughness` off z = 0. Open: it has a rim.
MeshData makeSheet(uint32_t cells, double roughness, Random& random);
/// A key along z whose bit points towards -y, and a plate across z with the hole that it passes with 0.05 to spare.
MeshData makeKey();
MeshData makeKeyhole();

/// Newell's teapot, z up, 6.4 wide from handle to spout: 32 Bezier patches of 10 x 10 cells, two triangles a cell, less
/// the ten of each of the eight patches at the lid's knob and the bottom's centre whose edge is one point:
/// 32 * 200 - 8 * 10 = 6,320 triangles.
MeshData makeTeapot();

/// How a soup's triangles are shaped.
enum class Soup {
  plain,       ///< of the order of a tenth of the soup
  needles,     ///< long, a millionth as wide
  degenerate,  ///< points, segments and doubled corners among plain ones
  lattice,     ///< corners on a grid of whole numbers: ties, edge-on and coplanar pairs
  tiny,        ///< plain, a millionth of the size
  far          ///< plain, modelled 1,000 soup sizes from the mesh's origin
};
inline constexpr std::array kSoups{Soup::plain, Soup::needles, Soup::degenerate, Soup::lattice, Soup::tiny, Soup::far};
const char* nameOf(Soup soup);

/// Random triangles, no corner shared, in a cube of edge 2 around the origin (scaled or moved as `soup` says).
MeshData makeSoup(Soup soup, uint32_t triangles, Random& random);

void addVertex(MeshData& mesh, const Vec3& p);
/// Appends `part`, moved by `offset`.
void append(MeshData& mesh, const MeshData& part, const Vec3& offset);

/// The radius of the sphere around the box's middle that holds the mesh, and that middle; and the box's longest edge.
struct MeshExtent {
  Vec3 middle{};
  double radius = 0;
  double longest = 0;
};
MeshExtent extentOf(const MeshData& mesh);
MeshData named(const char* name, MeshData mesh);
MeshData resized(MeshData mesh, double factor);

}  // namespace radar::tools
