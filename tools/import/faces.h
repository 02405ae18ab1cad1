// Faces of more than three corners, to triangles.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "import/mesh_file.h"

namespace radar::tools {

/// Of faces whose surface a file does not define.
struct OddFaces {
  uint64_t crossing = 0, bent = 0;  ///< those whose border crosses itself; those whose corners lie in no plane
  double most = 0;                  ///< how far corners of bent faces are from each other across their plane
};

/// Where the fan of a face would leave it, replaces the fan's triangles by as many others that fill the face exactly,
/// as seen along one of the axes, with the face's corners in its order. Corners may be repeated or lie on a line, and
/// an edge that leads to a hole and back is no border. Faces that cross themselves keep their fan. Throws
/// InputError that names `file` for a face of so many corners that this would take minutes.
void splitFaces(const std::string& file, MeshFile::Part& part, OddFaces& odd);

}  // namespace radar::tools
