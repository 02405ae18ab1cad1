#include "scene/mesh.h"

#include <algorithm>
#include <atomic>

#include "math/number_text.h"
#include "math/rounding.h"
#include "scene/parallel.h"

namespace radar {

namespace {

constexpr double kMostBound = 0x1p120;
// Least exponent of a mesh's unit: a float must hold its inverse.
constexpr int kLeastUnit = -126;
constexpr size_t kMostVertices = size_t{1} << 30;
constexpr size_t kChunk = 8192;

double edgeLength(const float* a, const float* b) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double difference = double(a[k]) - b[k];
    sum += difference * difference;
  }
  return std::sqrt(sum);
}

// A float that makes position - origin exact for every position in [lo, hi]: 0, or exact by Sterbenz's lemma.
double originOf(double lo, double hi) {
  const double middle = 0.5 * (lo + hi), half = 0.5 * (hi - lo);
  return std::abs(middle) >= 2.5 * half ? static_cast<float>(middle) : 0;
}

// Computes the derived members of a mesh but the tree. Once constructed, it does not throw.
class Derivation {
 public:
  explicit Derivation(Mesh& mesh)
      : mesh_(mesh), chunks_((mesh.triangleCount() + kChunk - 1) / kChunk), used_(mesh.vertexCount()) {
    for (UnwrittenVector<float>& along : mesh.local) along.resize(mesh.vertexCount());
  }

  // `box`: the bounds within which a host may deform the mesh, or empty.
  void derive(Box box) {
    parallelFor(mesh_.triangleCount(), kChunk, 0, [&](unsigned, size_t first, size_t last) {
      Chunk chunk;
      for (size_t t = first; t < last; ++t) {
        const float* p[3];
        for (int i = 0; i < 3; ++i) {
          const uint32_t vertex = mesh_.indices[3 * t + i];
          std::atomic_ref(used_[vertex]).store(1, std::memory_order_relaxed);  // several threads may write the same
          p[i] = &mesh_.positions[3 * size_t{vertex}];
          chunk.box.add({p[i][0], p[i][1], p[i][2]});
        }
        chunk.edges += edgeLength(p[0], p[1]) + edgeLength(p[1], p[2]) + edgeLength(p[2], p[0]);
      }
      chunks_[first / kChunk] = chunk;
    });
    double edges = 0;
    for (const Chunk& chunk : chunks_) {
      box.merge(chunk.box);
      edges += chunk.edges;
    }
    setBox(mesh_, box);
    mesh_.meanEdge = edges / static_cast<double>(mesh_.indices.size());
    parallelFor(mesh_.vertexCount(), kChunk, 0, [&](unsigned, size_t first, size_t last) {
      for (size_t v = first; v < last; ++v) {
        // Vertices that no triangle uses must not widen the window.
        const float* p = &mesh_.positions[3 * (used_[v] != 0 ? v : mesh_.indices[0])];
        for (int k = 0; k < 3; ++k) mesh_.local[k][v] = static_cast<float>(p[k] - mesh_.origin[k]);
      }
    });
  }

 private:
  struct Chunk {
    Box box;
    double edges = 0;  // the sum of their lengths
  };

  Mesh& mesh_;
  std::vector<Chunk> chunks_;  // of triangles
  std::vector<uint8_t> used_;  // by a triangle, of vertices
};

// The first of `count` numbers that fails, or `count`.
template <class Fails>
size_t firstThat(size_t count, const Fails& fails) {
  std::atomic<size_t> found = count;
  parallelFor(count, 8 * kChunk, 0, [&](unsigned, size_t first, size_t last) {
    while (first < last && !fails(first)) ++first;
    for (size_t least = found; first < last && first < least && !found.compare_exchange_weak(least, first);) {
    }
  });
  return found;
}

void requireFinite(const std::string& where, std::span<const float> positions) {
  const size_t i = firstThat(positions.size(), [&](size_t at) { return !std::isfinite(positions[at]); });
  if (i < positions.size()) throw Error(where + ": vertex " + std::to_string(i / 3) + " is not finite");
}

template <class Value>
void copyTo(UnwrittenVector<Value>& to, std::span<const Value> from) {
  to.resize(from.size());
  parallelFor(from.size(), 8 * kChunk, 0, [&](unsigned, size_t first, size_t last) {
    std::copy(from.begin() + first, from.begin() + last, to.begin() + first);
  });
}

// The bounds within which a host may deform the mesh, and its rest pose.
Box boundsOf(const Mesh& mesh) {
  Box box = mesh.box;
  for (int k = 0; k < 3; ++k) {
    box.lo[k] += mesh.origin[k];
    box.hi[k] += mesh.origin[k];
  }
  return box;
}

// Vertices that no triangle uses may be anywhere.
void requireInside(const Mesh& mesh, std::span<const float> positions) {
  const Box box = boundsOf(mesh);
  for (const uint32_t vertex : mesh.indices) {
    for (int k = 0; k < 3; ++k) {
      const float x = positions[3 * size_t{vertex} + k];
      if (x >= box.lo[k] && x <= box.hi[k]) continue;
      throw Error("setPositions: vertex " + std::to_string(vertex) + " is outside the mesh's bounds");
    }
  }
}

}  // namespace

Box boxOf(const char* call, const Bounds& bounds) {
  for (int k = 0; k < 3; ++k) {
    if (!(bounds.lo[k] <= bounds.hi[k] && bounds.lo[k] >= -kMostBound && bounds.hi[k] <= kMostBound)) {
      throw Error(std::string(call) + ": bounds: expected lo <= hi and magnitudes of at most 2^120, got " +
                  textOf(bounds.lo[k]) + " and " + textOf(bounds.hi[k]));
    }
  }
  Box box;
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = bounds.lo[k];
    box.hi[k] = bounds.hi[k];
  }
  return box;
}

void requireAtMost(const char* where, const char* what, size_t count, size_t most) {
  if (count <= most) return;
  throw Error(std::string(where) + ": expected at most " + std::to_string(most) + " " + what + ", got " +
              std::to_string(count));
}

void setBox(Mesh& mesh, const Box& box) {
  float largest = 0;
  for (int k = 0; k < 3; ++k) {
    mesh.farthest[k] = std::max(std::abs(box.lo[k]), std::abs(box.hi[k]));
    mesh.origin[k] = originOf(box.lo[k], box.hi[k]);
    mesh.box.lo[k] = box.lo[k] - mesh.origin[k];
    mesh.box.hi[k] = box.hi[k] - mesh.origin[k];
    mesh.reach[k] = roundUp(std::max(std::abs(mesh.box.lo[k]), std::abs(mesh.box.hi[k])));
    largest = std::max(largest, mesh.reach[k]);
  }
  mesh.unit = largest > 0 ? std::ldexp(1.0, std::max(std::ilogb(largest), kLeastUnit)) : 1;
}

Mesh makeMesh(std::span<const float> positions, std::span<const uint32_t> indices,
              const std::optional<Bounds>& bounds) {
  if (positions.size() % 3 != 0)
    throw Error("addMesh: positions: expected 3 floats per vertex, got " + std::to_string(positions.size()));
  if (indices.size() % 3 != 0)
    throw Error("addMesh: indices: expected 3 per triangle, got " + std::to_string(indices.size()));
  if (indices.empty()) throw Error("addMesh: expected at least one triangle, got none");
  requireAtMost("addMesh", "vertices", positions.size() / 3, kMostVertices);
  requireAtMost("addMesh", "triangles", indices.size() / 3, kMostItems);
  requireFinite("addMesh: positions", positions);
  for (size_t i = 0; bounds && i < positions.size(); ++i) {
    if (std::abs(positions[i]) > kMostBound) {
      throw Error("addMesh: positions: vertex " + std::to_string(i / 3) +
                  " of a mesh with bounds: expected coordinates of at most 2^120");
    }
  }
  const size_t wrong = firstThat(indices.size(), [&](size_t i) { return indices[i] >= positions.size() / 3; });
  if (wrong < indices.size()) {
    throw Error("addMesh: indices: triangle " + std::to_string(wrong / 3) + " refers to vertex " +
                std::to_string(indices[wrong]) + " of " + std::to_string(positions.size() / 3));
  }
  Mesh mesh;
  copyTo(mesh.positions, positions);
  copyTo(mesh.indices, indices);
  mesh.used = true;
  mesh.hasBounds = bounds.has_value();
  Box box;
  if (bounds) box = boxOf("addMesh", *bounds);
  // The host writes floats, so the bounds are rounded outwards to floats.
  for (int k = 0; k < 3 && bounds; ++k) {
    box.lo[k] = roundDown(box.lo[k]);
    box.hi[k] = roundUp(box.hi[k]);
  }
  Derivation(mesh).derive(box);
  mesh.tree = buildMeshTree(mesh);
  return mesh;
}

void movePositions(Mesh& mesh, std::span<const float> positions) {
  if (positions.size() != mesh.positions.size()) {
    throw Error("setPositions: expected " + std::to_string(mesh.positions.size()) + " floats, 3 for each vertex, got " +
                std::to_string(positions.size()));
  }
  requireFinite("setPositions", positions);
  if (mesh.hasBounds) requireInside(mesh, positions);
  const Box bounds = mesh.hasBounds ? boundsOf(mesh) : Box{};
  Derivation derivation(mesh);
  refitMeshTree(mesh, mesh.tree, [&] {
    copyTo(mesh.positions, positions);  // in place: a MeshView shows them
    derivation.derive(bounds);
  });
}

}  // namespace radar
