#include "import/faces.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "import/input_error.h"

namespace radar::tools {

namespace {

using Point = std::array<double, 2>;
using Triangle = std::array<uint32_t, 3>;

/// Of a face that is no fan; the time grows with the square.
constexpr uint32_t kMostCorners = 1u << 15;

/// Of what a face is bent by, in parts of its size: decimals of six digits bend a plane less.
constexpr double kLeastBent = 0x1p-10;

/// Where rounded numbers make a border cross itself, how far corners may be from a line that they were on, in parts of
/// the face's size. Decimals of six digits explain the greatest.
constexpr double kNear[] = {0, 0x1p-42, 0x1p-36, 0x1p-30, 0x1p-24, 0x1p-18};

/// The sign of p0 q1 - p1 q0 + q0 r1 - q1 r0 + r0 p1 - r1 p0 without rounding: the products, each as two doubles,
/// are added to a sum of doubles that do not overlap (Shewchuk, "Adaptive precision floating-point arithmetic", 1997).
int signOfTurn(const Point& p, const Point& q, const Point& r) {
  const double products[6][2] = {{p[0], q[1]}, {-p[1], q[0]}, {q[0], r[1]}, {-q[1], r[0]}, {r[0], p[1]}, {-r[1], p[0]}};
  std::array<double, 12> parts{};
  size_t count = 0;
  const auto add = [&](double term) {
    for (size_t i = 0; i < count; ++i) {
      const double sum = parts[i] + term, of = sum - term;
      parts[i] = (parts[i] - of) + (term - (sum - of));
      term = sum;
    }
    parts[count++] = term;
  };
  for (const auto& [a, b] : products) {
    const double product = a * b;
    add(std::fma(a, b, -product));
    add(product);
  }
  for (; count > 0; --count) {
    if (parts[count - 1] != 0) return parts[count - 1] > 0 ? 1 : -1;
  }
  return 0;
}

/// 1 if p, q, r turn left, -1 if right, 0 if they lie on a line.
int exactTurn(const Point& p, const Point& q, const Point& r) {
  const double left = (p[0] - r[0]) * (q[1] - r[1]), right = (p[1] - r[1]) * (q[0] - r[0]);
  const double difference = left - right;
  if (std::abs(difference) > 0x1p-50 * (std::abs(left) + std::abs(right))) return difference > 0 ? 1 : -1;
  return signOfTurn(p, q, r);
}

/// The border of a face, which runs counterclockwise, as corners are cut off.
class Border {
 public:
  /// Corners that are no farther than `near` from a line count as on it.
  Border(std::vector<Point> corners, double near) : points_(std::move(corners)), near_(near) {
    const auto count = static_cast<uint32_t>(points_.size());
    for (uint32_t i = 0; i < count; ++i) {
      next_.push_back((i + 1) % count);
      before_.push_back((i + count - 1) % count);
    }
    for (uint32_t i = 0; i < count; ++i) turns_.push_back(turnAt(i));
  }

  /// As many triangles as fill the face; fewer if it crosses itself.
  std::vector<Triangle> cut();

 private:
  /// Which corners may be cut off: spikes; also those whose triangle holds no other corner, even on its sides; those
  /// that lie on a line with their neighbours; those whose triangle holds no other corner inside, nor on the new side.
  enum class Step { spike, clear, flat, touched };

  int turn(const Point& p, const Point& q, const Point& r) const;
  int turnAt(uint32_t i) const { return turn(points_[before_[i]], points_[i], points_[next_[i]]); }
  bool isSpike(uint32_t i) const;
  bool mayCut(uint32_t i, Step step) const;
  bool isWithin(uint32_t corner, const Point& to) const;
  bool cutOne(uint32_t& from, Step step, std::vector<Triangle>& to);

  std::vector<Point> points_;
  double near_;
  std::vector<uint32_t> before_, next_;
  std::vector<int> turns_;
  uint32_t left_ = 0;
};

int Border::turn(const Point& p, const Point& q, const Point& r) const {
  if (near_ > 0) {
    const Point a{q[0] - p[0], q[1] - p[1]}, b{r[0] - q[0], r[1] - q[1]};
    const double longest =
        std::max({std::hypot(a[0], a[1]), std::hypot(b[0], b[1]), std::hypot(a[0] + b[0], a[1] + b[1])});
    if (std::abs(a[0] * b[1] - a[1] * b[0]) <= near_ * longest) return 0;
  }
  return exactTurn(p, q, r);
}

/// Whether a line from a corner begins inside the border, or along it.
bool Border::isWithin(uint32_t corner, const Point& to) const {
  const Point &before = points_[before_[corner]], &at = points_[corner], &next = points_[next_[corner]];
  const bool leftOfIn = turn(before, at, to) >= 0, leftOfOut = turn(at, next, to) >= 0;
  return turns_[corner] > 0 ? leftOfIn && leftOfOut : leftOfIn || leftOfOut;
}

/// Whether the border goes back at a corner, or stays there: such a corner has no angle, or a whole turn.
bool Border::isSpike(uint32_t i) const {
  const Point &a = points_[before_[i]], &b = points_[i], &c = points_[next_[i]];
  return turns_[i] == 0 && (a == b || b == c || (a[0] - b[0]) * (c[0] - b[0]) + (a[1] - b[1]) * (c[1] - b[1]) > 0);
}

bool Border::mayCut(uint32_t i, Step step) const {
  const Point &a = points_[before_[i]], &b = points_[i], &c = points_[next_[i]];
  if (step <= Step::clear && isSpike(i)) return true;
  if (step == Step::flat) return turns_[i] == 0;
  if (turns_[i] <= 0 || step == Step::spike) return false;
  if (!isWithin(before_[i], c) || !isWithin(next_[i], a)) return false;
  const auto [low0, high0] = std::minmax({a[0], b[0], c[0]});
  const auto [low1, high1] = std::minmax({a[1], b[1], c[1]});
  for (uint32_t k = next_[next_[i]]; k != before_[i]; k = next_[k]) {
    const Point& p = points_[k];
    if (turns_[k] > 0 || p[0] < low0 || p[0] > high0 || p[1] < low1 || p[1] > high1) continue;
    if (p == a || p == b || p == c) continue;
    const int ab = turn(a, b, p), bc = turn(b, c, p), ca = turn(c, a, p);
    if (ab < 0 || bc < 0 || ca < 0) continue;
    if (step == Step::clear || (ab > 0 && bc > 0)) return false;
  }
  return true;
}

/// Cuts the first corner off that may be, from `from` on, and leaves a neighbour there.
bool Border::cutOne(uint32_t& from, Step step, std::vector<Triangle>& to) {
  for (uint32_t tried = 0, i = from; tried < left_; ++tried, i = next_[i]) {
    if (!mayCut(i, step)) continue;
    const uint32_t before = before_[i], next = next_[i];
    to.push_back({before, i, next});
    next_[before] = next;
    before_[next] = before;
    --left_;
    turns_[before] = turnAt(before);
    turns_[next] = turnAt(next);
    // Going on round the border makes fewer long, thin triangles.
    from = isSpike(before) ? before : isSpike(next) ? next : next_[next];
    return true;
  }
  return false;
}

std::vector<Triangle> Border::cut() {
  std::vector<Triangle> triangles;
  left_ = static_cast<uint32_t>(points_.size());
  uint32_t from = 0;
  const auto cutAny = [&](std::initializer_list<Step> steps) {
    return std::ranges::any_of(steps, [&](Step step) { return cutOne(from, step, triangles); });
  };
  while (left_ > 3 && cutOne(from, Step::spike, triangles)) {
  }
  while (left_ > 3) {
    if (!cutAny({Step::clear, Step::flat, Step::touched})) return triangles;
  }
  if (turns_[from] >= 0) triangles.push_back({before_[from], from, next_[from]});
  return triangles;
}

using Corners = std::vector<std::array<double, 3>>;

/// Perpendicular to the face, as long as twice its area (Newell's formula, about a corner).
std::array<double, 3> normalOf(const Corners& corners) {
  std::array<double, 3> normal{};
  for (size_t i = 2; i < corners.size(); ++i) {
    std::array<double, 3> u{}, v{};
    for (size_t k = 0; k < 3; ++k) {
      u[k] = corners[i - 1][k] - corners[0][k];
      v[k] = corners[i][k] - corners[0][k];
    }
    for (size_t k = 0; k < 3; ++k) normal[k] += u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
  }
  return normal;
}

/// How far the corners are from each other along the normal; nothing if that is no more than rounding explains.
double bendOf(const Corners& corners, const std::array<double, 3>& normal) {
  const double length = std::hypot(normal[0], normal[1], normal[2]);
  if (!(length > 0)) return 0;
  double low = 0, high = 0, size = 0;
  for (const auto& corner : corners) {
    double along = 0;
    for (size_t k = 0; k < 3; ++k) {
      const double apart = corner[k] - corners[0][k];
      along += apart * (normal[k] / length);
      size = std::max(size, std::abs(apart));
    }
    low = std::min(low, along);
    high = std::max(high, along);
  }
  return high - low > kLeastBent * size ? high - low : 0;
}

/// As seen against the greatest component of the normal, counterclockwise.
std::vector<Point> seenFlat(const Corners& corners, const std::array<double, 3>& normal) {
  size_t axis = 0;
  for (size_t k = 1; k < 3; ++k) {
    if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
  }
  size_t first = (axis + 1) % 3, second = (axis + 2) % 3;
  if (normal[axis] < 0) std::swap(first, second);
  std::vector<Point> points;
  for (const auto& corner : corners) points.push_back({corner[first], corner[second]});
  return points;
}

bool areOnLine(const Corners& corners) {
  for (size_t axis = 0; axis < 3; ++axis) {
    std::array<double, 3> along{};
    along[axis] = 1;
    const std::vector<Point> points = seenFlat(corners, along);
    for (size_t i = 2; i < points.size(); ++i) {
      if (exactTurn(points[0], points[i - 1], points[i]) != 0) return false;
    }
  }
  return true;
}

double sizeOf(const std::vector<Point>& points) {
  double size = 0;
  for (const Point& p : points) size = std::max({size, std::abs(p[0] - points[0][0]), std::abs(p[1] - points[0][1])});
  return size;
}

double areaOf(const Point& p, const Point& q, const Point& r) {
  return ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])) / 2;
}

/// Whether the triangles together are as large as the face, but for rounding.
bool isFilled(const std::vector<Point>& points, const std::vector<Triangle>& triangles) {
  if (triangles.size() + 2 < points.size()) return false;
  double all = 0, face = 0;
  for (const auto& [a, b, c] : triangles) all += std::abs(areaOf(points[a], points[b], points[c]));
  for (size_t i = 2; i < points.size(); ++i) face += areaOf(points[0], points[i - 1], points[i]);
  return all <= face * (1 + 0x1p-10);
}

/// Triangles that all turn left cover the face as often as its border runs round it.
bool isFan(const std::vector<Point>& points) {
  for (size_t i = 2; i < points.size(); ++i) {
    if (exactTurn(points[0], points[i - 1], points[i]) < 0) return false;
  }
  return true;
}

}  // namespace

void splitFaces(const std::string& file, MeshFile::Part& part, OddFaces& odd) {
  Corners corners;
  std::vector<uint32_t> vertices;
  for (const MeshFile::Face& face : part.faces) {
    uint32_t* const fan = &part.indices[3 * size_t(face.firstTriangle)];
    vertices.assign(fan, fan + 2);
    for (uint32_t i = 2; i < face.corners; ++i) vertices.push_back(fan[3 * size_t(i - 2) + 2]);
    // Refused later, where that can be said of all triangles.
    if (std::ranges::any_of(vertices, [&](uint32_t v) { return v >= part.positions.size() / 3; })) continue;
    corners.clear();
    for (const uint32_t v : vertices) {
      const double* p = &part.positions[3 * size_t(v)];
      corners.push_back({p[0], p[1], p[2]});
    }
    const std::array<double, 3> normal = normalOf(corners);
    if (const double bend = bendOf(corners, normal); bend > 0) {
      ++odd.bent;
      odd.most = std::max(odd.most, bend);
    }
    if (normal == std::array<double, 3>{}) {
      if (!areOnLine(corners)) ++odd.crossing;
      continue;
    }
    const std::vector<Point> points = seenFlat(corners, normal);
    if (isFan(points)) continue;
    if (face.corners > kMostCorners) {
      throw InputError(file, "",
                       "expected at most " + std::to_string(kMostCorners) +
                           " corners of a face that is not convex, got " + std::to_string(face.corners));
    }
    std::vector<Triangle> triangles;
    const bool isSplit = std::ranges::any_of(kNear, [&](double near) {
      triangles = Border(points, near * sizeOf(points)).cut();
      return isFilled(points, triangles);
    });
    if (!isSplit) {
      ++odd.crossing;
      continue;
    }
    for (size_t i = 0; i < triangles.size(); ++i) {
      for (size_t k = 0; k < 3; ++k) fan[3 * i + k] = vertices[triangles[i][k]];
    }
  }
  part.faces.clear();
}

}  // namespace radar::tools
