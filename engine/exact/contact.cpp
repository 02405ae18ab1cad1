#include "exact/contact.h"

#include <bit>
#include <cmath>

#include "exact/determinant.h"
#include "exact/event.h"
#include "exact/scaled_int.h"

namespace radar::exact {

namespace {

constexpr int next(int i) {
  return i == 2 ? 0 : i + 1;
}

Span operator|(const Span& p, const Span& q) {
  return {p.a | q.a, p.b | q.b};
}

/// The ends of an edge, less the one that has no weight because the other is at the point.
unsigned edgeSpan(int from, int sideOfFrom, int sideOfTo) {
  return (sideOfTo != 0 ? 1u << from : 0) | (sideOfFrom != 0 ? 1u << next(from) : 0);
}

/// Of a span's corners that are in one place, as of a point or a segment, only the first.
unsigned distinct(unsigned corners, const Triangle& t) {
  for (int i = 1; i < 3; ++i) {
    for (int k = 0; k < i; ++k) {
      if ((corners >> k & 1) != 0 && t[i] == t[k]) corners &= ~(1u << i);
    }
  }
  return corners;
}

/// Finds the first and the last of the events added. If several events share an end, the choice depends on the events
/// only, not on their order; the span of the end is that of all.
class Ends {
 public:
  void add(const Event& event, const Span& span) {
    const int own = count_++;
    events_[own] = event;
    spans_[own] = span;
    hasRatio_[own] = false;
    between_ = between_ | span;
    if (own == 0) {
      atFirst_ = span;
      return;
    }
    const int first = order(own, first_);
    isPoint_ = isPoint_ && first == 0;
    if (first < 0 || (first == 0 && precedes(event, events_[first_]))) first_ = own;
    if (first <= 0) atFirst_ = first < 0 ? span : atFirst_ | span;
  }
  std::optional<Interval> interval(const Triangle& a, const Triangle& b, Ahead ahead) {
    if (count_ == 0) return std::nullopt;
    last_ = first_;
    atLast_ = atFirst_;
    if (!isPoint_ && (ahead == Ahead::whole || sign(events_[first_]) <= 0)) findLast();
    // The points of contact at any parameter are a polytope, with the events at its corners. Those at a parameter
    // between the ends include points inside it, which all corners span.
    const Span& own = spans_[first_];
    const bool isSharp = own.a == atFirst_.a && own.b == atFirst_.b && std::popcount(own.a) + std::popcount(own.b) == 4;
    const auto spanned = [&](const Span& span) { return Span{distinct(span.a, a), distinct(span.b, b)}; };
    return Interval{events_[first_], events_[last_], spanned(atFirst_), spanned(atLast_), spanned(between_), isSharp};
  }

 private:
  const Ratio& ratioOf(int i) {
    if (!hasRatio_[i]) ratios_[i] = ratio(events_[i]);
    hasRatio_[i] = true;
    return ratios_[i];
  }
  void findLast() {
    last_ = 0;
    atLast_ = spans_[0];
    for (int own = 1; own < count_; ++own) {
      const int last = order(own, last_);
      if (last > 0 || (last == 0 && precedes(events_[own], events_[last_]))) last_ = own;
      if (last >= 0) atLast_ = last > 0 ? spans_[own] : atLast_ | spans_[own];
    }
  }
  int order(int p, int q) {
    if (const auto sure = compareRoughly(events_[p], events_[q])) return *sure;
    return compare(ratioOf(p), ratioOf(q));
  }

  static constexpr int kMost = 18;  // planar: 9 vertices on edges each way; otherwise 3 + 3 + 9
  int count_ = 0, first_ = 0, last_ = 0;
  bool isPoint_ = true;  // all events so far have the same parameter
  Span atFirst_, atLast_, between_;
  std::array<Event, kMost> events_;
  std::array<Span, kMost> spans_;
  std::array<bool, kMost> hasRatio_;
  std::array<Ratio, kMost> ratios_;  // large, rarely touched
};

/// The signs of all orientations of the two triangles, seen along the direction: 18 minors of the 9 differences b[k] -
/// a[i]. Reversing the direction and swapping the triangles changes no bit of the minors' magnitudes.
class Signs {
 public:
  int edgeOfA[3][3];  ///< [i][k]: vertex k of b against the edge of a from i to next(i)
  int edgeOfB[3][3];  ///< [k][i]: vertex i of a against the edge of b from k to next(k)
  bool allZero = true;

  Signs(const Triangle& a, const Triangle& b, const Vector& direction) : a_(a), b_(b), direction_(direction) {
    Vector gap[3][3];
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) gap[i][k] = rounded({a[i], b[k]});
    }
    const double floor = underflowOf(direction);
    const auto minor = [&](int i, int k, int j, int l) {
      const Estimate rough = estimate(direction, gap[i][k], gap[j][l], floor);
      return std::abs(rough.value) > rough.error ? signOf(rough.value) : exactMinor(i, k, j, l);
    };
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        edgeOfA[i][k] = minor(i, k, next(i), k);
        edgeOfB[k][i] = minor(i, k, i, next(k));
        allZero = allZero && edgeOfA[i][k] == 0 && edgeOfB[k][i] == 0;
      }
    }
  }

  /// Whether vertex i of a is over the closed face b, which is not edge-on; and vice versa.
  bool vertexOverFace(int i) const { return oneSided(edgeOfB[0][i], edgeOfB[1][i], edgeOfB[2][i]); }
  bool faceOverVertex(int k) const { return oneSided(edgeOfA[0][k], edgeOfA[1][k], edgeOfA[2][k]); }
  /// The spans of the events in which they meet.
  Span vertexFaceSpan(int i) const { return {1u << i, faceSpan(edgeOfB[0][i], edgeOfB[1][i], edgeOfB[2][i])}; }
  Span faceVertexSpan(int k) const { return {faceSpan(edgeOfA[0][k], edgeOfA[1][k], edgeOfA[2][k]), 1u << k}; }
  Span edgesSpan(int i, int k) const {
    return {edgeSpan(i, edgeOfB[k][i], edgeOfB[k][next(i)]), edgeSpan(k, edgeOfA[i][k], edgeOfA[i][next(k)])};
  }
  /// Whether edge i of a crosses edge k of b, not in parallel, and not where a vertex over a face is the same event.
  bool edgesCross(int i, int k) const {
    const int p = edgeOfA[i][k], q = edgeOfA[i][next(k)], r = edgeOfB[k][i], s = edgeOfB[k][next(i)];
    if (p * q > 0 || r * s > 0 || (p == 0 && q == 0)) return false;
    if ((r == 0 && vertexOverFace(i)) || (s == 0 && vertexOverFace(next(i)))) return false;
    return !(p == 0 && faceOverVertex(k)) && !(q == 0 && faceOverVertex(next(k)));
  }

 private:
  /// A point on the line of an edge has no share of the corner across.
  static unsigned faceSpan(int side0, int side1, int side2) {
    return (side1 != 0 ? 1u : 0) | (side2 != 0 ? 2u : 0) | (side0 != 0 ? 4u : 0);
  }
  static bool oneSided(int p, int q, int r) {
    return (p != 0 || q != 0 || r != 0) && ((p >= 0 && q >= 0 && r >= 0) || (p <= 0 && q <= 0 && r <= 0));
  }

  int exactMinor(int i, int k, int j, int l) {
    // If one sign needs integers, others usually do, so the pair is converted once.
    if (fit_ == Fit::unknown) {
      const std::array<const Vector*, 6> corners{&a_[0], &a_[1], &a_[2], &b_[0], &b_[1], &b_[2]};
      const std::array<const Vector*, 1> way{&direction_};
      int exponent;
      fit_ = toScaledInts(corners, corners_, exponent) && toScaledInts(way, way_, exponent) ? Fit::yes : Fit::no;
    }
    if (fit_ == Fit::no) return exactSign({{kOrigin, direction_}, {a_[i], b_[k]}, {a_[j], b_[l]}});
    return determinant(way_[0], corners_[3 + k] - corners_[i], corners_[3 + l] - corners_[j]).sign();
  }

  enum class Fit { unknown, yes, no };
  const Triangle &a_, &b_;
  const Vector& direction_;
  Fit fit_ = Fit::unknown;
  std::array<IntVector, 6> corners_;
  std::array<IntVector, 1> way_;
};

/// For two triangles on one line, or two points, as seen along the direction: a problem in a plane that contains the
/// direction. Its basic solutions are a vertex on an edge or, if all points are on one line, a vertex on a vertex.
void addPlanar(const Triangle& a, const Triangle& b, const Vector& direction, Ends& ends) {
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
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) ends.add(vertexVertex(direction, a[i], b[k]), {1u << i, 1u << k});
    }
    return;
  }
  const auto over = [](int p, int q) { return p * q <= 0 && (p | q) != 0; };
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      if (const int p = side[i][k], q = side[i][next(k)]; over(p, q)) {
        ends.add(vertexEdge(direction, a[i], b[k], b[next(k)], across), {1u << i, edgeSpan(k, p, q)});
      }
      if (const int p = side[i][k], q = side[next(i)][k]; over(p, q)) {
        ends.add(edgeVertex(direction, a[i], a[next(i)], b[k], across), {edgeSpan(i, p, q), 1u << k});
      }
    }
  }
}

}  // namespace

std::optional<Interval> contact(const Triangle& a, const Triangle& b, const Vector& direction, Ahead ahead) {
  const Signs signs(a, b, direction);
  Ends ends;
  if (signs.allZero) {
    addPlanar(a, b, direction, ends);
    return ends.interval(a, b, ahead);
  }
  // These include every basic solution of the linear programme: least s at which a point of a, moved, is a point of b.
  for (int i = 0; i < 3; ++i) {
    if (signs.vertexOverFace(i)) ends.add(vertexFace(direction, a[i], b), signs.vertexFaceSpan(i));
    if (signs.faceOverVertex(i)) ends.add(faceVertex(direction, a, b[i]), signs.faceVertexSpan(i));
    for (int k = 0; k < 3; ++k) {
      if (!signs.edgesCross(i, k)) continue;
      ends.add(edgeEdge(direction, a[i], a[next(i)], b[k], b[next(k)]), signs.edgesSpan(i, k));
    }
  }
  return ends.interval(a, b, ahead);
}

Features Span::features() const {
  return {static_cast<Feature>(std::popcount(a)), static_cast<Feature>(std::popcount(b))};
}

Features featuresOf(const Event& event) {
  switch (event.kind) {
    case Kind::vertexFace:
      return {Feature::vertex, Feature::face};
    case Kind::faceVertex:
      return {Feature::face, Feature::vertex};
    case Kind::edgeEdge:
      return {Feature::edge, Feature::edge};
    case Kind::vertexEdge:
      return {Feature::vertex, Feature::edge};
    case Kind::edgeVertex:
      return {Feature::edge, Feature::vertex};
    case Kind::vertexVertex:
      break;
  }
  return {Feature::vertex, Feature::vertex};
}

}  // namespace radar::exact
