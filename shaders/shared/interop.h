// Trees, meshes and objects: the structs that C++ and GLSL share in all tiers (scalar layout; tests/unit compares the
// offsets). Each tier adds its structs, push constants and binding numbers in an interop.h of its own folder.
#ifndef RADAR_INTEROP_H
#define RADAR_INTEROP_H

#include "slot.h"

#ifdef __cplusplus
#include <cstdint>
namespace radar::gpu {
using uint = uint32_t;
// A 3x4 matrix, row-major.
using Rows = float[12];
using PreciseRows = double[12];
using Point = float[3];
using Quadruple = uint[4];
#else
// Vectors, because lavapipe loads a vector as fast as a scalar.
#define Rows vec4[3]
#define Point vec3
#define Quadruple uvec4
#ifdef RADAR_NO_DOUBLES  // the bits of doubles, for shaders that do no arithmetic with them
#define double uvec2
#define PreciseRows uvec4[6]
#else
#define PreciseRows dvec4[3]
#endif
#endif

INTEROP_CONST kNobody = 0xffffffffu;

// A node's link: the left child, which the right one follows; or, with kLinkLeaf, the first triangle or the object of a
// leaf. With kLinkPair the leaf also holds the next triangle.
INTEROP_CONST kLinkLeaf = 0x80000000u;
INTEROP_CONST kLinkPair = 0x40000000u;
INTEROP_CONST kLinkItem = 0x3fffffffu;

// A node of the tree over a mesh's triangles: a box of normalised vertices, and the slab |normal . q - slabMiddle| <=
// slabHalf.
struct MeshNode {
  Point centre;
  uint link;
  Point halfExtent;
  float slabMiddle;
  Point normal;
  float slabHalf;
};

// A node of the tree over objects: a world box, relative to the tree's anchor.
struct ObjectNode {
  Point centre;
  uint link;
  Point halfExtent;
  uint pad;
};

// Vertices and triangles; one buffer each for all meshes.
struct Vertex {
  Point position;  // as given
  uint number;     // in a host's buffer, less that of the mesh's first
};
struct Triangle {
  uint corners[3];  // vertices
  uint id;          // within its mesh
};

// A mesh in the world, for float arithmetic: its normalised vertices q (engine/scene/scene.h) are at matrix q + position.
struct Placement {
  Rows coarse;   // the leading 16 bits of the matrix; in [3] of each row the leading bits of the position
  Rows fine;     // the remainder
  Rows inverse;  // rows n_k with n_k . matrix close to the k-th unit vector; in [3] the vertex error that this causes
  Point reach;   // greatest |q|
  uint root;     // of the mesh's nodes
  Point origin;  // q = (vertex - origin) * perUnit
  float perUnit;
  float error;   // bound on the vertex error of coarse + fine on any axis
  float size;    // bound on a vertex's distance from the position, as a sum over the axes
  uint mask;     // of an object
  uint mesh;
};
INTEROP_CONST kPlacementTexels = 12;

struct MeshRecord {
  Point origin;   // of local vertices
  Point lo;       // of local vertices
  Point hi;
  float unit;     // normalised vertices = local * perUnit; 0: the mesh has been removed
  float perUnit;  // 1 / unit
  uint firstVertex;
  uint firstTriangle;
  uint firstNode;
};

struct ObjectRecord {
  PreciseRows pose;
  uint mesh;
  uint pad;
};

INTEROP_SLOT(kSlotMeshNodes, 0, MeshNode);
INTEROP_SLOT(kSlotObjectNodes, 1, ObjectNode);
INTEROP_SLOT(kSlotVertices, 2, Vertex);
INTEROP_SLOT(kSlotTriangles, 3, Triangle);
INTEROP_SLOT(kSlotPlacements, 4, Placement);  // one per object
INTEROP_SLOT(kSlotObjects, 13, ObjectRecord);
INTEROP_SLOT(kSlotMeshes, 17, MeshRecord);

// Features: 0..2 vertex i of the sensor's triangle on the other's face; 3..5 vertex i-3 of the scene's triangle on the
// sensor's face; 6 + 3*i + j: edge i of the sensor's triangle and edge j of the scene's, edges being (0,1), (1,2), (0,2).
INTEROP_CONST kFeatureEdges = 6;
INTEROP_CONST kFeatures = 15;

#ifdef __cplusplus
}  // namespace radar::gpu
#endif
#endif
