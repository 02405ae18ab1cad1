#include "workloads/shapes.h"

namespace radar::tools {

void addVertex(MeshData& mesh, const Vec3& p) {
  for (double value : p) mesh.positions.push_back(static_cast<float>(value));
}

MeshData named(const char* name, MeshData mesh) {
  mesh.name = name;
  return mesh;
}

MeshData resized(MeshData mesh, double factor) {
  for (float& value : mesh.positions) value = static_cast<float>(value * factor);
  return mesh;
}

MeshData makeBox(const Vec3& size) {
  MeshData mesh{"box", {}, {}};
  for (int i = 0; i < 8; ++i) {
    addVertex(mesh, {(i & 1 ? 0.5 : -0.5) * size[0], (i & 2 ? 0.5 : -0.5) * size[1], (i & 4 ? 0.5 : -0.5) * size[2]});
  }
  mesh.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                  2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  return mesh;
}

MeshData makeLathe(std::span<const std::array<double, 2>> profile, bool closed, uint32_t segments) {
  MeshData mesh;
  std::vector<uint32_t> first;  // of each profile point's circle; a pole has one vertex only
  for (const auto& [radius, height] : profile) {
    first.push_back(mesh.vertexCount());
    for (uint32_t s = 0; s < (radius == 0 ? 1 : segments); ++s) {
      const auto [c, n] = circlePoint(s, segments);
      addVertex(mesh, {radius * c, radius * n, height});
    }
  }
  const size_t count = profile.size();
  for (size_t i = 0; i + (closed ? 0 : 1) < count; ++i) {
    const size_t j = (i + 1) % count;
    const auto corner = [&](size_t point, uint32_t s) {
      return first[point] + (profile[point][0] == 0 ? 0 : s % segments);
    };
    const auto addTriangle = [&](uint32_t a, uint32_t b, uint32_t c) {
      mesh.indices.insert(mesh.indices.end(), {a, b, c});
    };
    for (uint32_t s = 0; s < segments; ++s) {
      if (profile[i][0] != 0) addTriangle(corner(i, s), corner(i, s + 1), corner(j, s));
      if (profile[j][0] != 0) addTriangle(corner(i, s + 1), corner(j, s + 1), corner(j, s));
    }
  }
  return mesh;
}

MeshData makeUvSphere(uint32_t rings, uint32_t segments) {
  std::vector<std::array<double, 2>> profile;
  for (uint32_t i = 0; i <= rings; ++i) {
    const auto [c, s] = circlePoint(i, 2 * rings);
    profile.push_back({i == 0 || i == rings ? 0.0 : s, -c});
  }
  return named("sphere", makeLathe(profile, false, segments));
}

MeshData makeTorus(double radius, double tube, uint32_t segments, uint32_t tubeSegments) {
  std::vector<std::array<double, 2>> profile;
  for (uint32_t i = 0; i < tubeSegments; ++i) {
    const auto [c, s] = circlePoint(i, tubeSegments);
    profile.push_back({radius + tube * c, tube * s});
  }
  return named("torus", makeLathe(profile, true, segments));
}

MeshData makeRod(double radius, double length, uint32_t segments) {
  const double h = 0.5 * length;
  const std::array<std::array<double, 2>, 4> profile{{{0, -h}, {radius, -h}, {radius, h}, {0, h}}};
  return named("rod", makeLathe(profile, false, segments));
}

MeshData makeCup(double radius, double height, double wall, uint32_t segments) {
  const std::array<std::array<double, 2>, 6> profile{
      {{0, 0}, {radius, 0}, {radius, height}, {radius - wall, height}, {radius - wall, wall}, {0, wall}}};
  return named("cup", makeLathe(profile, false, segments));
}

MeshData makePlate(double width, double depth, double thickness) {
  return named("plate", makeBox({width, depth, thickness}));
}

MeshData makeComb(uint32_t teeth, double pitch, double toothLength, double thickness) {
  const double width = pitch * (teeth - 0.5);
  MeshData mesh = named("comb", makeBox({width, thickness, thickness}));
  const MeshData tooth = makeBox({0.5 * pitch, thickness, toothLength});
  for (uint32_t i = 0; i < teeth; ++i) {
    append(mesh, tooth, {pitch * (i + 0.25) - 0.5 * width, 0, 0.5 * (thickness + toothLength)});
  }
  return mesh;
}

MeshData makeHook(double length, double reach, double tip, double thickness) {
  MeshData mesh = named("hook", makeBox({thickness, thickness, length}));
  append(mesh, makeBox({reach, thickness, thickness}), {0.5 * (reach - thickness), 0, -0.5 * (length - thickness)});
  append(mesh, makeBox({thickness, thickness, tip}), {reach - thickness, 0, -0.5 * (length - tip)});
  return mesh;
}

MeshData makeGrid(uint32_t cells, Diagonal diagonal, const std::function<Vec3(uint32_t, uint32_t)>& vertex) {
  MeshData mesh;
  for (uint32_t row = 0; row <= cells; ++row) {
    for (uint32_t column = 0; column <= cells; ++column) addVertex(mesh, vertex(column, row));
  }
  for (uint32_t row = 0; row < cells; ++row) {
    for (uint32_t column = 0; column < cells; ++column) {
      const uint32_t a = row * (cells + 1) + column, b = a + 1, c = a + cells + 1, d = c + 1;
      const bool rising = diagonal == Diagonal::rising;
      mesh.indices.insert(mesh.indices.end(), {a, b, rising ? d : c, rising ? a : b, d, c});
    }
  }
  return mesh;
}

MeshData makeSheet(uint32_t cells, double roughness, Random& random) {
  return named("sheet", makeGrid(cells, Diagonal::falling, [&](uint32_t x, uint32_t y) {
                 return Vec3{2.0 * x / cells - 1, 2.0 * y / cells - 1, random.uniform(-roughness, roughness)};
               }));
}

MeshData makeKey() {
  MeshData mesh = named("key", makeBox({0.5, 0.5, 4}));
  append(mesh, makeBox({0.2, 0.9, 0.3}), {0, -0.7, 1.5});
  return mesh;
}

MeshData makeKeyhole() {
  // What is left of a plate of 4 x 4 around a square hole of 0.6 and the slot of 0.3 below it: {x, y} from, to.
  constexpr std::array<std::array<double, 4>, 6> kParts{{{-2, -2, -0.3, 2},
                                                         {0.3, -2, 2, 2},
                                                         {-0.3, 0.3, 0.3, 2},
                                                         {-0.3, -2, 0.3, -1.2},
                                                         {-0.3, -1.2, -0.15, -0.3},
                                                         {0.15, -1.2, 0.3, -0.3}}};
  MeshData mesh{"keyhole", {}, {}};
  for (const auto& [x0, y0, x1, y1] : kParts) {
    append(mesh, makeBox({x1 - x0, y1 - y0, 0.2}), {0.5 * (x0 + x1), 0.5 * (y0 + y1), 0});
  }
  return mesh;
}

void append(MeshData& mesh, const MeshData& part, const Vec3& offset) {
  const uint32_t first = mesh.vertexCount();
  for (size_t i = 0; i < part.positions.size(); ++i) {
    mesh.positions.push_back(static_cast<float>(part.positions[i] + offset[i % 3]));
  }
  for (uint32_t index : part.indices) mesh.indices.push_back(first + index);
}

MeshExtent extentOf(const MeshData& mesh) {
  const Bounds bounds = boundsOf({mesh.positions, mesh.indices}, {});
  MeshExtent extent{0.5 * (bounds.low + bounds.high), 0, bounds.longest()};
  for (uint32_t vertex : mesh.indices) {
    const float* p = &mesh.positions[3 * size_t{vertex}];
    extent.radius = std::max(extent.radius, lengthOf(Vec3{p[0], p[1], p[2]} - extent.middle));
  }
  return extent;
}

}  // namespace radar::tools
