// Meshes that people made, from assimp's test models and CGAL's data.
#pragma once

#include "measure/case_run.h"

namespace radar::test {

/// By name: assimp's are in OBJ, PLY, STL, Collada and glTF; CGAL's are closed and with holes, knotted and convoluted.
tools::MeshFamilies realMeshes();

}  // namespace radar::test
