// Meshes that people made, from assimp's test models and CGAL's data.
#pragma once

#include <vector>

#include "selftest/random_queries.h"
#include "workloads/workload.h"

namespace radar::test {

/// In OBJ, PLY, STL, Collada and glTF.
std::vector<tools::MeshData> assimpModels();
/// Closed and with holes, knotted and convoluted.
std::vector<tools::MeshData> cgalMeshes();
/// Both.
tools::MeshFamilies realMeshes();

}  // namespace radar::test
