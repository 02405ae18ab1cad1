// Meshes that people made, from assimp's test models and CGAL's data.
#pragma once

#include "measure/case_run.h"

namespace radar::test {

// They are where the build found them; or in folders `assimp` and `cgal` of the folder that the environment variable
// RADAR_TEST_MESHES names.

/// An engine of many parts, in glTF.
std::string engineFile();

/// By name: assimp's are in OBJ, PLY, STL, Collada and glTF; CGAL's are closed and with holes, knotted and convoluted.
tools::MeshFamilies realMeshes();

}  // namespace radar::test
