// Mesh files to triangles.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "import/float_vertices.h"
#include "import/input_error.h"
#include "workloads/workload.h"

namespace radar::tools {

/// A mesh of a file. Where floats do not suffice for the numbers of the file, they are about a base.
struct FileMesh : MeshData {
  std::array<double, 3> base{};  ///< a vertex is there plus its position; poses that the file's numbers are meant for
                                 ///< become those of the mesh by aboutBase()
};

/// The nodes of a file that have triangles, depth-first.
struct Assembly {
  struct Part {
    std::string name;  ///< the node's; others may have the same
    uint32_t mesh = 0;
    Transform fileFromNode;  ///< the transforms of the node and those above it, multiplied in double precision
  };
  std::vector<FileMesh> meshes;  ///< in the frames of their nodes; nodes that place the same meshes share one
  std::vector<Part> parts;

  /// The number in `parts` of a node: `node` is that number or the name that it alone has. Throws InputError that names
  /// `file` and the node.
  uint32_t numberOf(const std::string& file, const std::string& node) const;
  /// The geometry of such a node.
  const FileMesh& meshOf(const std::string& file, const std::string& node) const {
    return meshes[parts[numberOf(file, node)].mesh];
  }
};

/// A mesh's name: FILE, or FILE#NODE for the geometry of one node.
struct MeshName {
  std::filesystem::path file;
  std::optional<std::string> node;
};
/// A whole name that is a file's has no node. Otherwise the file is what stands before the first # that ends the name
/// of a file.
MeshName splitMeshName(const std::filesystem::path& name);

/// Reads a file as one mesh: nodes depth-first, each node's meshes in order, their vertices and faces in order, as
/// often as nodes place them. Node transforms are multiplied in double precision and each vertex is rounded once to
/// float, about a base (floatVertices()), with a warning that says by how much if that spoils the mesh. Faces of more
/// than three corners are split: into a fan from their first corner, if it does not leave the face, else by cutting
/// corners off. A warning counts those that are not plane or cross themselves. Points and lines are dropped and counted
/// in a warning. Triangles that a mirroring transform places are wound the other way round, so that what is outside
/// stays outside. No vertex is joined or moved, no face removed, and only of glTF are unused vertices left out. With a
/// FILE#NODE, reads that node's meshes only, in the node's own frame.
///
/// OBJ, STL, PLY, OFF, 3MF and glTF 2 are read here: a number in text becomes the nearest double.
/// Assimp reads all others, in a child process, which it may crash; numbers in text, or doubles, are the floats that it
/// makes of them.
///
/// Each number is multiplied by `scale` in double precision, after the nodes' transforms and before it is rounded to
/// float, so that 0.001 makes metres of millimetres; poses are then in the scaled unit.
///
/// Appends to `warnings` what a person should know, each beginning with the file. Throws InputError if the scale is not
/// finite and above 0, or if the file is missing, no regular file or broken, holds no triangle, a vertex that is not
/// finite or a face that names a vertex that does not exist, or if its nodes place so much so often that the mesh would
/// be too large.
FileMesh readMesh(const std::filesystem::path& name, std::vector<std::string>& warnings, double scale = 1);

/// Reads a file as an assembly, otherwise as above. Also throws InputError if a node's pose is singular.
Assembly readAssembly(const std::filesystem::path& file, std::vector<std::string>& warnings, double scale = 1);

/// A file read both ways.
struct FileContent {
  std::string unit;  ///< of its numbers, as the file or its format says; or empty
  FileMesh whole;
  Assembly assembly;
};
FileContent readContent(const std::filesystem::path& file, std::vector<std::string>& warnings);

}  // namespace radar::tools
