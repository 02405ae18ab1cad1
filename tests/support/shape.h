// Placed triangles, to be compared exactly with others.
#pragma once

#include <vector>

#include "cpu/approach.h"
#include "exact/blocking.h"
#include "math/box.h"

namespace radar::test {

struct Shape {
  std::vector<exact::Triangle> triangles{};
  Box box{};

  void add(const exact::Triangle& corners) {
    for (const Vector& corner : corners) box.add(corner);
    triangles.push_back(corners);
  }
};

/// Whether surfaces cross by more than `slack`; with a clearance, whether they are nearer than that less `slack`.
inline bool meet(const Shape& first, const Shape& second, double clearance, double slack) {
  if (!overlap(first.box, second.box, clearance)) return false;
  for (const exact::Triangle& a : first.triangles) {
    for (const exact::Triangle& b : second.triangles) {
      if (clearance == 0 ? exact::cross(a, b, slack) : cpu::separationOf(a, b).distance < clearance - slack)
        return true;
    }
  }
  return false;
}

}  // namespace radar::test
