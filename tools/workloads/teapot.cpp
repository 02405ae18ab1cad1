// Martin Newell's teapot (1975), from its published control points, with the lid and bottom that the data has had
// since. The body, lid and bottom are quarter turns of a profile, reflected in x and y; handle and spout are reflected
// in y.
#include "workloads/shapes.h"

namespace radar::tools {

namespace {

constexpr int kCells = 10;

/// A row of a turned patch: control points (r,0,z), (r,-s,z), (s,-r,z), (0,-r,z).
struct Ring {
  double r, s, z;
};

constexpr Ring kTurned[6][4] = {
    // rim
    {{1.4, 0.784, 2.4}, {1.3375, 0.749, 2.53125}, {1.4375, 0.805, 2.53125}, {1.5, 0.84, 2.4}},
    // upper and lower body
    {{1.5, 0.84, 2.4}, {1.75, 0.98, 1.875}, {2, 1.12, 1.35}, {2, 1.12, 0.9}},
    {{2, 1.12, 0.9}, {2, 1.12, 0.45}, {1.5, 0.84, 0.225}, {1.5, 0.84, 0.15}},
    // knob and lid
    {{0, 0, 3.15}, {0.8, 0.45, 3.15}, {0, 0, 2.85}, {0.2, 0.112, 2.7}},
    {{0.2, 0.112, 2.7}, {0.4, 0.224, 2.55}, {1.3, 0.728, 2.55}, {1.3, 0.728, 2.4}},
    // bottom
    {{0, 0, 0}, {1.425, 0.798, 0}, {1.5, 0.84, 0.075}, {1.5, 0.84, 0.15}},
};

/// A row of a patch across the half y <= 0: inner point and outer point in the xz plane, `y` how far it bulges.
struct Arc {
  double innerX, innerZ, outerX, outerZ, y;
};

constexpr Arc kHalves[4][4] = {
    // handle
    {{-1.6, 2.025, -1.5, 2.25, 0.3},
     {-2.3, 2.025, -2.5, 2.25, 0.3},
     {-2.7, 2.025, -3, 2.25, 0.3},
     {-2.7, 1.8, -3, 1.8, 0.3}},
    {{-2.7, 1.8, -3, 1.8, 0.3},
     {-2.7, 1.575, -3, 1.35, 0.3},
     {-2.5, 1.125, -2.65, 0.9375, 0.3},
     {-2, 0.9, -1.9, 0.6, 0.3}},
    // spout
    {{1.7, 1.425, 1.7, 0.6, 0.66},
     {2.6, 1.425, 3.1, 0.825, 0.66},
     {2.3, 2.1, 2.4, 2.025, 0.25},
     {2.7, 2.4, 3.3, 2.4, 0.25}},
    {{2.7, 2.4, 3.3, 2.4, 0.25},
     {2.8, 2.475, 3.525, 2.49375, 0.25},
     {2.9, 2.475, 3.45, 2.5125, 0.15},
     {2.8, 2.4, 3.2, 2.4, 0.15}},
};

using Patch = std::array<std::array<Vec3, 4>, 4>;

Patch patchOf(const Ring (&rows)[4]) {
  Patch patch;
  for (int i = 0; i < 4; ++i) {
    const auto [r, s, z] = rows[i];
    patch[i] = {{{r, 0, z}, {r, -s, z}, {s, -r, z}, {0, -r, z}}};
  }
  return patch;
}

Patch patchOf(const Arc (&rows)[4]) {
  Patch patch;
  for (int i = 0; i < 4; ++i) {
    const auto [innerX, innerZ, outerX, outerZ, y] = rows[i];
    patch[i] = {{{innerX, 0, innerZ}, {innerX, -y, innerZ}, {outerX, -y, outerZ}, {outerX, 0, outerZ}}};
  }
  return patch;
}

std::array<double, 4> bernstein(int step) {
  const double t = double(step) / kCells, s = 1 - t;
  return {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
}

Vec3 pointOf(const Patch& patch, int rowStep, int columnStep) {
  const auto rows = bernstein(rowStep), columns = bernstein(columnStep);
  Vec3 point{};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) point = point + (rows[i] * columns[j]) * patch[i][j];
  }
  return point;
}

void addPatch(MeshData& mesh, const Patch& patch, double mirrorX, double mirrorY) {
  const uint32_t first = mesh.vertexCount();
  for (int i = 0; i <= kCells; ++i) {
    for (int j = 0; j <= kCells; ++j) {
      const auto [x, y, z] = pointOf(patch, i, j);
      addVertex(mesh, {mirrorX * x, mirrorY * y, z});
    }
  }
  const bool pole = patch[0][0] == patch[0][3];
  const bool turned = mirrorX * mirrorY < 0;
  const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
    mesh.indices.insert(mesh.indices.end(), {a, turned ? c : b, turned ? b : c});
  };
  for (uint32_t i = 0; i < kCells; ++i) {
    for (uint32_t j = 0; j < kCells; ++j) {
      const uint32_t a = first + i * (kCells + 1) + j, c = a + kCells + 1;
      if (!(pole && i == 0)) add(a, a + 1, c);
      add(a + 1, c + 1, c);
    }
  }
}

}  // namespace

MeshData makeTeapot() {
  MeshData mesh{"teapot", {}, {}};
  for (const auto& rows : kTurned) {
    const Patch patch = patchOf(rows);
    for (double x : {1.0, -1.0}) {
      for (double y : {1.0, -1.0}) addPatch(mesh, patch, x, y);
    }
  }
  for (const auto& rows : kHalves) {
    const Patch patch = patchOf(rows);
    for (double y : {1.0, -1.0}) addPatch(mesh, patch, 1, y);
  }
  return mesh;
}

}  // namespace radar::tools
