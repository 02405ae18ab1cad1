// What a mesh file holds, before its nodes are put together.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "radar/scene.h"

namespace radar::tools {

struct MeshFile {
  /// A face of more than three corners, which is a fan of triangles from its first corner.
  struct Face {
    uint32_t firstTriangle = 0, corners = 0;
  };
  struct Part {
    std::vector<double> positions;   ///< 3 per vertex; may be infinite or no number
    std::vector<uint32_t> indices;   ///< 3 vertex numbers per triangle; may name vertices that do not exist
    std::vector<Face> faces;         ///< whose fans may leave them
    uint64_t points = 0, lines = 0;  ///< which are no surface; their vertices are among the positions

    /// Adds a face, or counts it if it is a point or a line. `corners` are vertex numbers.
    void addFace(const std::vector<uint32_t>& corners);
  };
  struct Node {
    std::string name;
    Transform fileFromNode;       ///< the transforms of the node and those above it, multiplied in double precision
    std::vector<uint32_t> parts;  ///< their numbers; parts may be placed by several nodes
  };
  std::vector<Part> parts;
  std::vector<Node> nodes;  ///< depth-first; those without parts may be missing
  std::string unit;         ///< of 3MF and glTF
  bool isOddUnit = false;   ///< of 3MF, not the usual millimetre
};

/// a b: the pose of what b places in the frame that a places.
Transform product(const Transform& a, const Transform& b);

/// As bytes, to pass it on to another process. The way back throws std::runtime_error for bytes that are no MeshFile.
std::string bytesOf(const MeshFile& file);
MeshFile meshFileFrom(std::string_view bytes);

}  // namespace radar::tools
