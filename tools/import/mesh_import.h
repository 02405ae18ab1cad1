// Mesh files to triangles, by assimp.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "import/input_error.h"
#include "workloads/workload.h"

namespace radar::tools {

/// Reads any file assimp reads as one mesh: nodes depth-first, each node's meshes in order, their vertices and faces in
/// order, as often as nodes place them. Node transforms are multiplied in double precision and each vertex is rounded
/// once to float. Faces of more than three corners are fanned from their first corner; points and lines are dropped and
/// counted in a warning. No vertex is joined, moved or left out, no face removed. Assimp itself gives floats: numbers
/// written in text, or in doubles, are what its importer makes of them.
///
/// Appends to `warnings` what a person should know, each beginning with the file. Throws InputError if the file is
/// missing or broken, holds no triangle, a vertex that is not finite or a face that names a vertex that does not exist.
MeshData readMesh(const std::filesystem::path& file, std::vector<std::string>& warnings);

}  // namespace radar::tools
