// The readers of OBJ, STL, PLY, OFF, 3MF and glTF 2, whose numbers become the nearest doubles, and that of all other
// formats.
//
// A file that ends early, names a vertex that does not exist or is otherwise broken is refused with an InputError.
#pragma once

#include <filesystem>

#include "import/mesh_file.h"
#include "import/text.h"

namespace radar::tools {

/// A node for each object or group, in the order in which they begin; each has a vertex for each corner of its faces,
/// lines and points. Homogeneous coordinates are divided in double precision. Ignores normals, texture coordinates,
/// colours and material libraries. Refuses free-form surfaces.
MeshFile readObj(Text text);

/// A node for each solid; binary files are one. Three vertices for each facet. Ignores normals and colours.
MeshFile readStl(Text text);

/// One node; ASCII and both kinds of binary files; faces, and triangle strips, whose triangles with a repeated
/// vertex, which only lead on, are left out.
MeshFile readPly(Text text);

/// One node. Vertices and faces have a line each, whose rest (normals, colours) is ignored. Homogeneous coordinates are
/// divided in double precision.
MeshFile readOff(Text text);

/// A node for each object with a mesh that a build item places, also through components. The unit, colours and
/// materials are ignored. Refuses extensions that a reader must know, but those of materials and of production without
/// paths.
MeshFile readThreeMf(Text text);

/// glTF 2, text or binary, with its buffers beside it or within. A node for each node with a mesh, or for each instance
/// that EXT_mesh_gpu_instancing gives it; a part for each primitive, of the vertices that its triangles use, numbered
/// as they are first used. Applies default weights of morph targets and skins as their joints stand; animations are
/// ignored. Reads all component types, normalised (KHR_mesh_quantization) and sparse ones, too. Refuses what is
/// compressed, if nothing else is there, and extensions that are required and not known, by name.
MeshFile readGltf(Text text);

/// A file of another format, by assimp. May crash or run for ever on a broken file; throws std::bad_alloc, too.
MeshFile readWithAssimp(const std::filesystem::path& file);

}  // namespace radar::tools
