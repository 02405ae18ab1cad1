#include "import/mesh_facts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "workloads/vectors.h"

namespace radar::tools {

namespace {

using Corner = std::array<float, 3>;
using Triangle = std::array<uint32_t, 3>;

/// The triangles' corners by place: the same number stands for the same place.
std::vector<Triangle> trianglesByPlace(const MeshData& mesh, std::vector<Corner>& places) {
  const auto at = [&](uint32_t vertex) {
    const float* p = &mesh.positions[3 * size_t(vertex)];
    return Corner{p[0] + 0.0f, p[1] + 0.0f, p[2] + 0.0f};  // -0 is 0
  };
  for (const uint32_t vertex : mesh.indices) places.push_back(at(vertex));
  std::ranges::sort(places);
  places.erase(std::ranges::unique(places).begin(), places.end());
  std::vector<uint32_t> numbers(mesh.vertexCount());
  for (uint32_t vertex = 0; vertex < numbers.size(); ++vertex) {
    numbers[vertex] = static_cast<uint32_t>(std::ranges::lower_bound(places, at(vertex)) - places.begin());
  }
  std::vector<Triangle> triangles;
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    triangles.push_back({numbers[mesh.indices[i]], numbers[mesh.indices[i + 1]], numbers[mesh.indices[i + 2]]});
  }
  return triangles;
}

/// Drops triangles that are there again with the same winding; counts all that are there again.
uint64_t dropRepeated(std::vector<Triangle>& triangles) {
  for (Triangle& t : triangles) std::ranges::rotate(t, std::ranges::min_element(t));
  const auto unwound = [](const Triangle& t) { return Triangle{t[0], std::min(t[1], t[2]), std::max(t[1], t[2])}; };
  std::ranges::sort(triangles, {}, [&](const Triangle& t) { return std::pair(unwound(t), t); });
  uint64_t repeated = 0;
  for (size_t i = 1; i < triangles.size(); ++i) repeated += unwound(triangles[i]) == unwound(triangles[i - 1]);
  triangles.erase(std::ranges::unique(triangles).begin(), triangles.end());
  return repeated;
}

void countEdges(const std::vector<Triangle>& triangles, MeshFacts& facts) {
  struct Edge {
    uint32_t low, high;
    int direction;
  };
  std::vector<Edge> edges;
  for (const Triangle& t : triangles) {
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t from = t[k], to = t[(k + 1) % 3];
      if (from != to) edges.push_back({std::min(from, to), std::max(from, to), from < to ? 1 : -1});
    }
  }
  const auto ends = [](const Edge& edge) { return std::pair(edge.low, edge.high); };
  std::ranges::sort(edges, {}, ends);
  for (size_t i = 0; i < edges.size();) {
    const size_t first = i;
    int sum = 0;
    for (; i < edges.size() && ends(edges[i]) == ends(edges[first]); ++i) sum += edges[i].direction;
    if ((i - first) % 2 == 1) {
      ++facts.borderEdges;
    } else if (sum != 0) {
      ++facts.unevenEdges;
    }
  }
}

/// The number of each place's shell.
std::vector<uint32_t> shellsOf(const std::vector<Triangle>& triangles, size_t places) {
  std::vector<uint32_t> parent(places);
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](uint32_t place) {
    while (parent[place] != place) place = parent[place] = parent[parent[place]];
    return place;
  };
  for (const Triangle& t : triangles) {
    for (size_t k = 1; k < 3; ++k) parent[root(t[k])] = root(t[0]);
  }
  for (uint32_t place = 0; place < places; ++place) parent[place] = root(place);
  return parent;
}

}  // namespace

Box boxOf(const FileMesh& mesh, const Transform& pose) {
  constexpr double kMost = std::numeric_limits<double>::infinity();
  Box box{{kMost, kMost, kMost}, {-kMost, -kMost, -kMost}};
  const Transform placed = aboutBase(pose, mesh.base);
  for (const uint32_t vertex : mesh.indices) {
    const Vec3 corner = transformPoint(placed, &mesh.positions[3 * size_t(vertex)]);
    for (size_t k = 0; k < 3; ++k) {
      box.low[k] = std::min(box.low[k], corner[k]);
      box.high[k] = std::max(box.high[k], corner[k]);
    }
  }
  return box;
}

MeshFacts factsOf(const MeshData& mesh) {
  MeshFacts facts;
  std::vector<Corner> places;
  std::vector<Triangle> triangles = trianglesByPlace(mesh, places);
  if (triangles.empty()) return facts;
  const auto at = [&](uint32_t place) { return Vec3{places[place][0], places[place][1], places[place][2]}; };
  const auto across = [](const Vec3& a, const Vec3& b) {
    return Vec3{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  for (const Triangle& t : triangles) {
    facts.degenerate += across(at(t[1]) - at(t[0]), at(t[2]) - at(t[0])) == Vec3{};
  }
  facts.repeated = dropRepeated(triangles);
  countEdges(triangles, facts);
  const std::vector<uint32_t> shellOf = shellsOf(triangles, places.size());
  struct Volume {
    double signedSum = 0, sum = 0;
  };
  std::vector<Volume> volumes(places.size());
  const Vec3 origin = at(0);  // differences from one corner lose less than the corners' own products
  for (const Triangle& t : triangles) {
    const double part = dot(at(t[0]) - origin, across(at(t[1]) - origin, at(t[2]) - origin)) / 6;
    volumes[shellOf[t[0]]].signedSum += part;
    volumes[shellOf[t[0]]].sum += std::abs(part);
  }
  for (uint32_t place = 0; place < places.size(); ++place) {
    if (shellOf[place] != place) continue;
    const Volume& volume = volumes[place];
    ++facts.shells;
    facts.volume += volume.signedSum;
    if (std::abs(volume.signedSum) <= 0x1p-40 * volume.sum) {
      ++facts.flatShells;
    } else if (volume.signedSum < 0) {
      ++facts.inwardShells;
    }
  }
  return facts;
}

std::string inWords(const MeshFacts& facts) {
  std::string text;
  if (!facts.isClosed()) {
    text = "open: " + counted(facts.borderEdges, "border edge");
  } else if (!facts.isEven()) {
    text = "closed, but the winding turns over at " + counted(facts.unevenEdges, "edge");
  } else if (facts.flatShells == facts.shells) {
    text = "closed, but it encloses nothing";
  } else if (facts.inwardShells == 0) {
    text = "closed, wound outwards";
  } else if (facts.inwardShells == facts.shells) {
    text = "closed, wound inwards";
  } else {
    text = "closed, " + std::to_string(facts.inwardShells) + " of " + counted(facts.shells, "shell") +
           " wound inwards, as only cavities should be";
  }
  if (facts.degenerate > 0) text += "; " + counted(facts.degenerate, "triangle has", "triangles have") + " no area";
  if (facts.repeated > 0) text += "; " + counted(facts.repeated, "triangle is", "triangles are") + " there again";
  return text;
}

}  // namespace radar::tools
