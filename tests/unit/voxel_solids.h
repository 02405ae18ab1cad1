// Closed solids of unit cubes on a grid that fit each other exactly, and the truth about their motions: how far a solid
// can move until its interior would meet that of another.
#pragma once

#include <map>
#include <set>

#include "soups.h"

namespace voxels {

using Cell = std::array<int, 3>;
using Solid = std::set<Cell>;

/// The boundary of a solid, wound outwards, each square cut along a random diagonal.
inline soups::Mesh boundary(const Solid& solid, soups::Random& random) {
  soups::Mesh mesh;
  std::map<Cell, uint32_t> vertices;
  const auto vertex = [&](const Cell& at) {
    const auto [place, isNew] = vertices.try_emplace(at, static_cast<uint32_t>(vertices.size()));
    if (isNew) {
      for (int c : at) mesh.positions.push_back(static_cast<float>(c));
    }
    return place->second;
  };
  for (const Cell& cell : solid) {
    for (int k = 0; k < 3; ++k) {
      for (int side : {0, 1}) {
        Cell next = cell;
        next[k] += side == 1 ? 1 : -1;
        if (solid.contains(next)) continue;
        const int x = (k + 1) % 3, y = (k + 2) % 3;
        std::array<uint32_t, 4> corners;  // counter-clockwise as seen from outside
        for (int i = 0; i < 4; ++i) {
          Cell at = cell;
          at[k] += side;
          at[x] += (i == 1 || i == 2) == (side == 1) ? 1 : 0;
          at[y] += i >= 2 ? 1 : 0;
          corners[i] = vertex(at);
        }
        const int first = random.integer(0, 1);
        for (const auto& triangle : {std::array{0, 1, 2}, std::array{0, 2, 3}}) {
          for (int i : triangle) mesh.indices.push_back(corners[(i + first) % 4]);
        }
      }
    }
  }
  return mesh;
}

/// Disjoint solids that fill part of a grid of `side` cells along each axis. Some may be empty.
inline std::vector<Solid> packing(soups::Random& random, int side, int count) {
  std::vector<Solid> solids(static_cast<size_t>(count));
  std::set<Cell> taken;
  const auto randomCell = [&] {
    return Cell{random.integer(0, side - 1), random.integer(0, side - 1), random.integer(0, side - 1)};
  };
  for (Solid& solid : solids) {
    const Cell cell = randomCell();
    if (taken.insert(cell).second) solid.insert(cell);
  }
  for (int step = random.integer(0, 4 * side); step > 0; --step) {
    Solid& solid = solids[static_cast<size_t>(random.integer(0, count - 1))];
    if (solid.empty()) continue;
    Cell cell = *std::next(solid.begin(), random.integer(0, static_cast<int>(solid.size()) - 1));
    cell[static_cast<size_t>(random.integer(0, 2))] += random.chance(0.5) ? 1 : -1;
    const bool inside = std::all_of(cell.begin(), cell.end(), [&](int c) { return c >= 0 && c < side; });
    if (inside && taken.insert(cell).second) solid.insert(cell);
  }
  return solids;
}

/// The least parameter s >= 0 at which the interior of `a`, moved by s * direction for integer components, begins to
/// meet that of `b`; -1 if it never does.
inline oracle::Rational begins(const Solid& a, const Solid& b, const std::array<int, 3>& direction) {
  using oracle::Rational;
  Rational best = -1;
  for (const Cell& p : a) {
    for (const Cell& q : b) {
      Rational from = 0, to = 1'000'000;
      bool meets = true;
      for (int k = 0; k < 3; ++k) {
        const int gap = q[k] - p[k], d = direction[k];
        if (d == 0) {
          meets = meets && gap == 0;
          continue;
        }
        // Open cubes overlap along this axis for |gap - s d| < 1.
        const Rational one = Rational(gap - 1) / d, other = Rational(gap + 1) / d;
        from = std::max(from, std::min(one, other));
        to = std::min(to, std::max(one, other));
      }
      if (meets && from < to && (best < 0 || from < best)) best = from;
    }
  }
  return best;
}

}  // namespace voxels
