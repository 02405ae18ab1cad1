#include "workloads/voxels.h"

#include <algorithm>
#include <iterator>
#include <map>

#include "workloads/shapes.h"

namespace radar::tools {

MeshData boundaryOf(const Solid& solid, Random& random) {
  MeshData mesh{"solid", {}, {}};
  std::map<Voxel, uint32_t> vertices;
  const auto vertex = [&](const Voxel& at) {
    const auto [place, isNew] = vertices.try_emplace(at, mesh.vertexCount());
    if (isNew) addVertex(mesh, {double(at[0]), double(at[1]), double(at[2])});
    return place->second;
  };
  for (const Voxel& cell : solid) {
    for (size_t k = 0; k < 3; ++k) {
      for (int side : {0, 1}) {
        Voxel next = cell;
        next[k] += side == 1 ? 1 : -1;
        if (solid.contains(next)) continue;
        const size_t x = (k + 1) % 3, y = (k + 2) % 3;
        std::array<uint32_t, 4> corners;  // counter-clockwise as seen from outside
        for (size_t i = 0; i < 4; ++i) {
          Voxel at = cell;
          at[k] += side;
          at[x] += (i == 1 || i == 2) == (side == 1) ? 1 : 0;
          at[y] += i >= 2 ? 1 : 0;
          corners[i] = vertex(at);
        }
        const uint32_t first = random.below(2);
        for (const uint32_t i : {0, 1, 2, 0, 2, 3}) mesh.indices.push_back(corners[(i + first) % 4]);
      }
    }
  }
  return mesh;
}

std::vector<Solid> packedSolids(uint32_t side, uint32_t count, Random& random) {
  std::vector<Solid> solids(count);
  Solid taken;
  for (Solid& solid : solids) {
    Voxel cell;
    for (int& c : cell) c = static_cast<int>(random.below(side));
    if (taken.insert(cell).second) solid.insert(cell);
  }
  for (uint32_t step = random.below(4 * side + 1); step > 0; --step) {
    Solid& solid = solids[random.below(count)];
    if (solid.empty()) continue;
    Voxel cell = *std::next(solid.begin(), random.below(static_cast<uint32_t>(solid.size())));
    int& moved = cell[random.below(3)];
    moved += random.oneIn(2) ? 1 : -1;
    const bool isInside = moved >= 0 && moved < static_cast<int>(side);
    if (isInside && taken.insert(cell).second) solid.insert(cell);
  }
  std::erase_if(solids, [](const Solid& solid) { return solid.empty(); });
  return solids;
}

std::vector<Solid> burrPieces() {
  std::vector<Solid> pieces;
  Solid taken;
  for (int side : {-2, 0}) {
    for (size_t axis = 0; axis < 3; ++axis) {
      Solid& piece = pieces.emplace_back();
      for (int along = -3; along < 3; ++along) {
        for (int across : {side, side + 1}) {
          for (int up : {-1, 0}) {
            Voxel cell;
            cell[axis] = along;
            cell[(axis + 1) % 3] = across;
            cell[(axis + 2) % 3] = up;
            if (taken.insert(cell).second) piece.insert(cell);
          }
        }
      }
    }
  }
  return pieces;
}

}  // namespace radar::tools
