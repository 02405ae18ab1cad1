#include "exact/contact.h"

#include <cmath>

#include "exact/determinant.h"
#include "exact/event.h"

namespace radar::exact {

namespace {

constexpr int next(int i) {
  return i == 2 ? 0 : i + 1;
}

/// Keeps the ends of the interval among the events it is shown. Where several events share an end, the one that is
/// kept depends on the events alone, not on the order in which they come.
class Ends {
 public:
  void add(const Event& event) {
    if (!ends_) {
      ends_ = Interval{event, event};
      return;
    }
    const int first = compare(event, ends_->first);
    if (first < 0 || (first == 0 && precedes(event, ends_->first))) ends_->first = event;
    const int last = compare(event, ends_->last);
    if (last > 0 || (last == 0 && precedes(event, ends_->last))) ends_->last = event;
  }
  const std::optional<Interval>& interval() const { return ends_; }

 private:
  std::optional<Interval> ends_;
};

/// All signs of orientation that the two triangles have as seen along the direction: 18 minors of the 9 differences
/// b[k] - a[i]. Reversing the direction and swapping the triangles changes no bit of their magnitudes.
struct Signs {
  int edgeOfA[3][3];  ///< [i][k]: vertex k of b against the edge of a from i to next(i)
  int edgeOfB[3][3];  ///< [k][i]: vertex i of a against the edge of b from k to next(k)
  bool allZero = true;

  Signs(const Triangle& a, const Triangle& b, const Vec& direction) {
    Vec gap[3][3];
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) gap[i][k] = rounded({a[i], b[k]});
    }
    const double floor = underflowOf(direction);
    const auto minor = [&](int i, int k, int j, int l) {
      const Estimate rough = estimate(direction, gap[i][k], gap[j][l], floor);
      if (std::abs(rough.value) > rough.error) return signOf(rough.value);
      countExactDecision();
      return exactly({{kOrigin, direction}, {a[i], b[k]}, {a[j], b[l]}}).sign();
    };
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        edgeOfA[i][k] = minor(i, k, next(i), k);
        edgeOfB[k][i] = minor(i, k, i, next(k));
        allZero = allZero && edgeOfA[i][k] == 0 && edgeOfB[k][i] == 0;
      }
    }
  }
};

bool inside(int p, int q, int r) {
  return (p | q | r) != 0 && ((p >= 0 && q >= 0 && r >= 0) || (p <= 0 && q <= 0 && r <= 0));
}

/// Both triangles lie on one line as seen along the direction, or on two points: a problem in a plane that contains the
/// direction. Its basic solutions are a vertex on an edge or, where all is on one line, a vertex on a vertex.
void addPlanar(const Triangle& a, const Triangle& b, const Vec& direction, Ends& ends) {
  int across = 0;
  int side[3][3];
  for (; across < 3; ++across) {
    bool any = false;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        side[i][k] = crossSign({kOrigin, direction}, {a[i], b[k]}, across);
        any = any || side[i][k] != 0;
      }
    }
    if (any) break;
  }
  if (across == 3) {
    for (const Vec& p : a) {
      for (const Vec& q : b) ends.add(vertexVertex(direction, p, q));
    }
    return;
  }
  const auto over = [](int p, int q) { return p * q <= 0 && (p | q) != 0; };
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      if (over(side[i][k], side[i][next(k)])) ends.add(vertexEdge(direction, a[i], b[k], b[next(k)], across));
      if (over(side[i][k], side[next(i)][k])) ends.add(edgeVertex(direction, a[i], a[next(i)], b[k], across));
    }
  }
}

}  // namespace

std::optional<Interval> contact(const Triangle& a, const Triangle& b, const Vec& direction) {
  const Signs signs(a, b, direction);
  Ends ends;
  if (signs.allZero) {
    addPlanar(a, b, direction, ends);
    return ends.interval();
  }
  // Every basic solution of the linear programme "least s with a point of a, moved, on a point of b" is one of these.
  for (int i = 0; i < 3; ++i) {
    if (inside(signs.edgeOfB[0][i], signs.edgeOfB[1][i], signs.edgeOfB[2][i])) {
      ends.add(vertexFace(direction, a[i], b));
    }
    if (inside(signs.edgeOfA[0][i], signs.edgeOfA[1][i], signs.edgeOfA[2][i])) {
      ends.add(faceVertex(direction, a, b[i]));
    }
    for (int k = 0; k < 3; ++k) {
      const int p = signs.edgeOfA[i][k], q = signs.edgeOfA[i][next(k)];
      const int r = signs.edgeOfB[k][i], s = signs.edgeOfB[k][next(i)];
      if (p * q <= 0 && (p | q) != 0 && r * s <= 0) {
        ends.add(edgeEdge(direction, a[i], a[next(i)], b[k], b[next(k)]));
      }
    }
  }
  return ends.interval();
}

}  // namespace radar::exact
