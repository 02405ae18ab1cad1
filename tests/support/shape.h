// Placed triangles, to be compared exactly with others.
#pragma once

#include <vector>

#include "cpu/approach.h"
#include "exact/blocking.h"
#include "math/box.h"

namespace radar::test {

struct Shape {
  std::vector<exact::Triangle> triangles{};
  std::vector<Box> boxes{};  ///< theirs
  Box box{};

  void add(const exact::Triangle& corners) {
    Box own;
    for (const Vector& corner : corners) own.add(corner);
    box.merge(own);
    boxes.push_back(own);
    triangles.push_back(corners);
  }
};

/// Whether surfaces cross by more than `slack`; with a clearance, whether they are nearer than that less `slack`.
inline bool meet(const Shape& first, const Shape& second, double clearance, double slack) {
  if (!overlap(first.box, second.box, clearance)) return false;
  for (size_t i = 0; i < first.triangles.size(); ++i) {
    if (!overlap(first.boxes[i], second.box, clearance)) continue;
    for (size_t k = 0; k < second.triangles.size(); ++k) {
      if (!overlap(first.boxes[i], second.boxes[k], clearance)) continue;
      const exact::Triangle &a = first.triangles[i], &b = second.triangles[k];
      if (clearance == 0 ? exact::cross(a, b, slack) : cpu::separationOf(a, b).distance < clearance - slack)
        return true;
    }
  }
  return false;
}

}  // namespace radar::test
