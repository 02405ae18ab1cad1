#include "cpu/parting_plane.h"

#include <algorithm>
#include <cmath>

namespace radar::cpu {

namespace {

// Where a gap is wide compared to rounding, a dozen suffice.
constexpr int kMostPlanes = 60;
// Parts of a squared length: less of a gain than this is none, less of a volume is flat.
constexpr double kLittle = 1e-14;

/// Of the hull of points, given one after the other, the nearest to the origin; of the points, those stay whose mean it
/// is. (Wolfe, docs/method.md)
class NearestOfHull {
 public:
  explicit NearestOfHull(const Vector& first) : points_{first}, nearest_(first) { shares_[0] = 1; }

  const Vector& nearest() const { return nearest_; }
  /// False if that finds no nearer one.
  bool add(const Vector& p);

 private:
  /// Shares of the points, of sum 1, some below 0 maybe, whose mean is the nearest of all such means. False if the
  /// points are as good as in a common plane, line or place.
  bool nearestShares(std::array<double, 4>& out) const;
  void remove(int point);

  std::array<Vector, 4> points_;
  std::array<double, 4> shares_{};
  int count_ = 1;
  Vector nearest_;
};

bool NearestOfHull::nearestShares(std::array<double, 4>& out) const {
  // Normal equations of what is added to the first point, eliminated.
  std::array<std::array<double, 4>, 3> rows{};
  std::array<Vector, 3> from{};
  const int size = count_ - 1;
  for (int i = 0; i < size; ++i) from[i] = minus(points_[i + 1], points_[0]);
  for (int i = 0; i < size; ++i) {
    for (int k = 0; k < size; ++k) rows[i][k] = dot(from[i], from[k]);
    rows[i][3] = -dot(from[i], points_[0]);
  }
  for (int i = 0; i < size; ++i) {
    if (!(rows[i][i] > kLittle * dot(from[i], from[i]))) return false;
    for (int k = i + 1; k < size; ++k) {
      const double times = rows[k][i] / rows[i][i];
      for (int j = i; j < 4; ++j) rows[k][j] -= times * rows[i][j];
    }
  }
  out = {1, 0, 0, 0};
  for (int i = size - 1; i >= 0; --i) {
    double rest = rows[i][3];
    for (int k = i + 1; k < size; ++k) rest -= rows[i][k] * out[k + 1];
    out[i + 1] = rest / rows[i][i];
    out[0] -= out[i + 1];
  }
  return true;
}

void NearestOfHull::remove(int point) {
  --count_;
  points_[point] = points_[count_];
  shares_[point] = shares_[count_];
}

bool NearestOfHull::add(const Vector& p) {
  if (count_ == 4) return false;  // the origin is within
  points_[count_] = p;
  shares_[count_++] = 0;
  for (;;) {
    std::array<double, 4> goal;
    if (!nearestShares(goal)) return false;
    // That far towards them all shares stay above 0.
    double way = 1;
    int last = -1;
    for (int i = 0; i < count_; ++i) {
      if (goal[i] > 0) continue;
      const double until = shares_[i] > 0 ? shares_[i] / (shares_[i] - goal[i]) : 0;
      if (last >= 0 && until >= way) continue;
      way = until;
      last = i;
    }
    for (int i = 0; i < count_; ++i) shares_[i] += way * (goal[i] - shares_[i]);
    if (last < 0) break;
    remove(last);
  }
  Vector mean{};
  for (int i = 0; i < count_; ++i) mean = along(mean, shares_[i], points_[i]);
  if (!(dot(mean, mean) < dot(nearest_, nearest_))) return false;
  nearest_ = mean;
  return true;
}

}  // namespace

void addPartingPlanes(const HullMotion& motion, const exact::Triangle& corners, double error, double latest,
                      FreeTimes& free) {
  const RingHull& hull = motion.hull;
  const Vector& way = motion.way;
  // After a while, all of the triangle is behind the hull.
  double behind = 0;
  for (const Vector& corner : corners) behind = std::max(behind, hull.support(scaled(-1, way)) + dot(way, corner));
  free.add(motion, scaled(-1, way), corners, error);
  const double end = std::min(latest, 1.01 * behind / dot(way, way));
  // What the triangle sweeps until then is convex. Of its differences from points of the hull:
  const auto leastAlong = [&](const Vector& n) {
    const Vector* least = &corners[0];
    for (const Vector& corner : corners) least = dot(n, corner) < dot(n, *least) ? &corner : least;
    return minus(along(*least, dot(n, way) > 0 ? -end : 0, way), hull.farthest(hull.ringAlong(n), n));
  };
  NearestOfHull gap(leastAlong(scaled(-1, way)));
  for (int i = 0; i < kMostPlanes && !free.isFreeUntil(latest); ++i) {
    const Vector n = gap.nearest(), least = leastAlong(n);
    if (dot(n, least) > 0) free.add(motion, n, corners, error);
    if (!(dot(n, minus(n, least)) > kLittle * dot(n, n)) || !gap.add(least)) return;
  }
}

}  // namespace radar::cpu
