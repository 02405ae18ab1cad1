// What a mesh is like, for people who are to use it.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "import/mesh_import.h"

namespace radar::tools {

struct Box {
  std::array<double, 3> low{}, high{};
};
/// Around the triangles of a mesh that has some, placed by a pose that is meant for the file's numbers.
Box boxOf(const FileMesh& mesh, const Transform& pose = {});

/// How a surface is closed and wound. Corners are the same if they are at the same place, whatever their number, and a
/// triangle that is there again with the same winding counts once.
struct MeshFacts {
  uint64_t degenerate = 0;                    ///< triangles without area, as doubles say
  uint64_t repeated = 0;                      ///< triangles whose corners an earlier one has, in any order
  uint64_t borderEdges = 0;                   ///< edges that an odd number of triangles have
  uint64_t unevenEdges = 0;                   ///< others that are not passed as often in each direction
  uint64_t shells = 0;                        ///< of which no two share a corner
  uint64_t inwardShells = 0, flatShells = 0;  ///< of negative volume, and of none to rounding
  double volume = 0;                          ///< signed; of the space enclosed if the mesh is closed and even

  bool isClosed() const { return borderEdges == 0; }
  /// Closed, and each triangle continues its neighbours: then shells have a volume.
  bool isEven() const { return isClosed() && unevenEdges == 0; }
};
MeshFacts factsOf(const MeshData& mesh);

/// "closed, wound outwards", "open: 4 border edges; 1 triangle has no area".
std::string inWords(const MeshFacts& facts);

}  // namespace radar::tools
