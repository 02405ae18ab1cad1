#include "exact/contact_normal.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <optional>
#include <utility>
#include <vector>

#include "exact/event.h"
#include "exact/scaled_int.h"

namespace radar::exact {

namespace {

using Exact = Three<Dyadic>;

constexpr int next(int i) {
  return i == 2 ? 0 : i + 1;
}

Exact between(const Vector& from, const Vector& to) {
  return minus(numbers<Dyadic>(to), numbers<Dyadic>(from));
}

Exact times(const Dyadic& f, const Exact& v) {
  return {f * v[0], f * v[1], f * v[2]};
}

bool isZero(const Exact& v) {
  return v[0].sign() == 0 && v[1].sign() == 0 && v[2].sign() == 0;
}

/// The point at / weight; the weight is not 0.
struct Place {
  Exact at;
  Dyadic weight;
};

Place placeOf(const Vector& p) {
  return {numbers<Dyadic>(p), Dyadic(1)};
}

/// p moved along the event's direction by its parameter, or by its negative.
Place moved(const Vector& p, const Event& e, bool back) {
  const Ratio s = ratio(e);
  const Exact way = times(s.num, numbers<Dyadic>(e.direction));
  return {minus(times(s.den, numbers<Dyadic>(p)), back ? way : times(Dyadic(-1), way)), s.den};
}

/// Where the edge from p to q crosses that from r to s, as seen along the direction.
Place crossing(const Vector& direction, const Vector& p, const Vector& q, const Vector& r, const Vector& s) {
  const Difference d{kOrigin, direction};
  const Dyadic atP = exactly({d, {p, r}, {p, s}}), atQ = exactly({d, {q, r}, {q, s}});
  return {minus(times(atP, numbers<Dyadic>(q)), times(atQ, numbers<Dyadic>(p))), atP - atQ};
}

/// Where the features of an event touch: on the moving one, at the start, and on the resting one.
std::pair<Place, Place> placesOf(const Event& e) {
  switch (e.kind) {
    case Kind::vertexFace:
    case Kind::vertexEdge:
      return {placeOf(e.from), moved(e.from, e, false)};
    case Kind::faceVertex:
    case Kind::edgeVertex:
      return {moved(e.to, e, true), placeOf(e.to)};
    case Kind::edgeEdge:
      return {crossing(e.direction, e.x0, e.x1, e.y0, e.y1), crossing(e.direction, e.y0, e.y1, e.x0, e.x1)};
    case Kind::vertexVertex:
      break;
  }
  return {placeOf(e.from), placeOf(e.to)};
}

/// If a triangle contains the point, those of its sides that do, else none: bit i for the one from corner i.
std::optional<unsigned> sidesAt(const Place& point, const Triangle& t) {
  Exact to[3], side[3];
  for (int i = 0; i < 3; ++i) {
    to[i] = minus(times(point.weight, numbers<Dyadic>(t[i])), point.at);
    side[i] = between(t[i], t[next(i)]);
  }
  const Exact normal = crossProduct(side[0], side[1]);
  unsigned sides = 0;
  if (isZero(normal)) {
    for (int i = 0; i < 3; ++i) {
      const bool isOn = isZero(crossProduct(side[i], to[i])) && inner(to[i], to[next(i)]).sign() <= 0;
      sides |= isOn ? 1u << i : 0;
    }
    return sides != 0 ? std::optional(sides) : std::nullopt;
  }
  if (inner(normal, to[0]).sign() != 0) return std::nullopt;
  int least = 1, greatest = -1;
  for (int i = 0; i < 3; ++i) {
    const int at = inner(normal, crossProduct(side[i], to[i])).sign();
    least = std::min(least, at);
    greatest = std::max(greatest, at);
    sides |= at == 0 ? 1u << i : 0;
  }
  return least >= 0 || greatest <= 0 ? std::optional(sides) : std::nullopt;
}

/// The ends of an edge.
using Edge = std::pair<Vector, Vector>;

Difference along(const Edge& edge) {
  return {edge.first, edge.second};
}

/// A plane through any point. Its normal is that of two edges, turned against the direction.
class Plane {
 public:
  Plane(const Vector& direction, const Edge& x, const Edge& y)
      : x_(x),
        y_(y),
        roundedX_(rounded(along(x))),
        roundedY_(rounded(along(y))),
        turn_(-sideOf({kOrigin, direction})) {}

  /// -1, 0 or 1: the sign of normal . (to - from). All 0 if the edges are parallel, as seen along the direction.
  int operator()(const Vector& from, const Vector& to) const { return turn_ * sideOf({from, to}); }
  bool isSound() const { return turn_ != 0; }
  Exact normal() const {
    return times(Dyadic(turn_), crossProduct(between(x_.first, x_.second), between(y_.first, y_.second)));
  }

 private:
  static bool isAlong(const Difference& w, const Edge& edge) {
    return (w.from == edge.first && w.to == edge.second) || (w.from == edge.second && w.to == edge.first);
  }
  // As sign(Determinant), but what integers decide shares the product of the edges.
  int sideOf(const Difference& w) const {
    const Vector gap = rounded(w);
    const Estimate rough = estimate(gap, roundedX_, roundedY_, underflowOf(gap));
    if (std::abs(rough.value) > rough.error) return signOf(rough.value);
    if (w.from == w.to || isAlong(w, x_) || isAlong(w, y_)) return 0;
    if (!isScaled_) {
      isScaled_ = true;
      const auto x = scaledVector(along(x_)), y = scaledVector(along(y_));
      if (x && y) product_ = cross(x->c, y->c);
    }
    if (const auto scaled = product_ ? scaledVector(w) : std::nullopt) return dot(scaled->c, *product_).sign();
    return exactSign({w, along(x_), along(y_)});
  }

  Edge x_, y_;
  Vector roundedX_, roundedY_;
  mutable bool isScaled_ = false;
  mutable std::optional<IntNormal> product_;
  int turn_;
};

/// A plane of any normal.
class AnyPlane {
 public:
  explicit AnyPlane(const Exact& normal) : normal_(normal) {}
  int operator()(const Vector& from, const Vector& to) const { return inner(normal_, between(from, to)).sign(); }
  const Exact& normal() const { return normal_; }

 private:
  Exact normal_;
};

template <class Item>
void sortOnce(std::vector<Item>& items) {
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

/// The triangles of some pairs, each once.
std::vector<const Triangle*> trianglesOf(std::span<const TouchingPair* const> pairs, bool moving) {
  std::vector<std::pair<uint32_t, const Triangle*>> named;
  for (const TouchingPair* pair : pairs) {
    named.emplace_back(moving ? pair->name.triA : pair->name.triB, moving ? &pair->placed.a : &pair->placed.b);
  }
  const auto isSame = [](const auto& p, const auto& q) { return p.first == q.first; };
  std::sort(named.begin(), named.end());
  named.erase(std::unique(named.begin(), named.end(), isSame), named.end());
  std::vector<const Triangle*> triangles;
  for (const auto& [name, triangle] : named) triangles.push_back(triangle);
  return triangles;
}

/// What a normal is to keep apart: corners of the moving shape and of the resting one, each once.
struct Sides {
  std::vector<Vector> a, b;

  explicit Sides(std::span<const TouchingPair* const> pairs)
      : a(cornersOf(trianglesOf(pairs, true))), b(cornersOf(trianglesOf(pairs, false))) {}

 private:
  static std::vector<Vector> cornersOf(const std::vector<const Triangle*>& triangles) {
    std::vector<Vector> corners;
    for (const Triangle* t : triangles) corners.insert(corners.end(), t->begin(), t->end());
    sortOnce(corners);
    return corners;
  }
};

/// The edges across which the normals of two triangles' faces are, and those of an edge of each.
std::array<std::pair<Edge, Edge>, 11> edgesOf(const PlacedPair& pair) {
  // Sorted, so that the numbering of corners does not matter.
  auto [a, b] = pair;
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  const auto edge = [](const Triangle& t, int i) { return Edge{t[i], t[next(i)]}; };
  std::array<std::pair<Edge, Edge>, 11> edges{{{edge(a, 0), edge(a, 1)}, {edge(b, 0), edge(b, 1)}}};
  for (int i = 0; i < 9; ++i) edges[2 + i] = {edge(a, i / 3), edge(b, i % 3)};
  return edges;
}

/// What a normal is to keep apart, of pairs that touch at one moment.
class Contacts {
 public:
  /// The first of `pairs` touches then at points of this span.
  Contacts(const Vector& direction, const Span& span, std::span<const TouchingPair* const> pairs)
      : direction_(direction), pairs_(pairs.begin(), pairs.end()), corners_(pairs) {
    assert(span.a != 0 && span.b != 0);
    const PlacedPair& first = pairs[0]->placed;
    for (int i = 0; i < 3; ++i) {
      if ((span.a >> i & 1) != 0) atA_.push_back(first.a[i]);
      if ((span.b >> i & 1) != 0) atB_.push_back(first.b[i]);
    }
  }

  /// Whether a plane keeps the triangles of each pair apart.
  template <class AnyKind>
  bool areApart(const AnyKind& plane) const {
    if (!isFirstApart(plane)) return false;
    if (areBeside(plane, corners_.a, corners_.b)) return true;
    return std::all_of(pairs_.begin(), pairs_.end(), [&](const TouchingPair* pair) {
      return areBeside(plane, pair->placed.a, pair->placed.b) || areApart(plane.normal(), pair->placed);
    });
  }

  /// The first of all normals against the direction that are at the rim of those for which all are apart; `edges` are
  /// those by which the triangles lead away from a point where all of them touch.
  std::optional<Vector> rim(std::span<const Edge> edges) const {
    for (size_t i = 0; i < edges.size(); ++i) {
      for (size_t k = 0; k < i; ++k) {
        const Plane plane(direction_, edges[k], edges[i]);
        if (plane.isSound() && areApart(plane)) return unitOf(plane.normal());
      }
    }
    // Else everything is in one plane with the direction, and the rim is across edges, in that plane.
    const Exact d = numbers<Dyadic>(direction_);
    for (const Edge& edge : edges) {
      const Exact e = between(edge.first, edge.second);
      const AnyPlane plane{minus(times(inner(e, d), e), times(inner(e, e), d))};
      if (!isZero(plane.normal()) && areApart(plane)) return unitOf(plane.normal());
    }
    const AnyPlane across{times(Dyadic(-1), d)};
    return areApart(across) ? std::optional(unitOf(across.normal())) : std::nullopt;
  }

  /// The first normal of a pair for which all are apart: of a face, or of an edge of each.
  std::optional<Vector> own() const {
    std::vector<Plane> tried;
    for (const TouchingPair* pair : pairs_) {
      for (const auto& [x, y] : edgesOf(pair->placed)) {
        const Plane plane(direction_, x, y);
        if (!plane.isSound() || !isFirstApart(plane)) continue;
        const auto isSame = [&, &one = x, &other = y](const Plane& p) {
          return p(one.first, one.second) == 0 && p(other.first, other.second) == 0;
        };
        if (std::any_of(tried.begin(), tried.end(), isSame)) continue;
        if (areApart(plane)) return unitOf(plane.normal());
        tried.push_back(plane);
      }
    }
    return std::nullopt;
  }

 private:
  template <class AnyKind>
  bool isFirstApart(const AnyKind& plane) const {
    const auto isOn = [&](const std::vector<Vector>& at) {
      return std::all_of(at.begin() + 1, at.end(), [&](const Vector& p) { return plane(at[0], p) == 0; });
    };
    const PlacedPair& first = pairs_[0]->placed;
    return areBeside(plane, first.a, first.b) && isOn(atA_) && isOn(atB_);
  }
  /// Whether corners are on their sides of the plane through the contact of the first pair.
  template <class AnyKind>
  bool areBeside(const AnyKind& plane, std::span<const Vector> a, std::span<const Vector> b) const {
    return std::all_of(b.begin(), b.end(), [&](const Vector& p) { return plane(atB_[0], p) <= 0; }) &&
           std::all_of(a.begin(), a.end(), [&](const Vector& p) { return plane(atA_[0], p) >= 0; });
  }
  /// Whether the triangles of a pair are on different sides of some plane of that normal.
  bool areApart(const Exact& n, const PlacedPair& pair) const {
    Dyadic b = inner(n, between(atB_[0], pair.b[0])), a = inner(n, between(atA_[0], pair.a[0]));
    for (int i = 1; i < 3; ++i) {
      const Dyadic otherB = inner(n, between(atB_[0], pair.b[i])), otherA = inner(n, between(atA_[0], pair.a[i]));
      if ((otherB - b).sign() > 0) b = otherB;
      if ((otherA - a).sign() < 0) a = otherA;
    }
    return (b - a).sign() <= 0;
  }

  Vector direction_;
  std::vector<const TouchingPair*> pairs_;
  Sides corners_;
  std::vector<Vector> atA_, atB_;  // corners that span the contact of the first pair
};

/// The triangles that contain a point, and the edges by which they lead away from it.
class Around {
 public:
  Around(std::span<const TouchingPair* const> pairs, bool moving, const Place& point) : moving_(moving) {
    for (const Triangle* triangle : trianglesOf(pairs, moving)) {
      // Sorted, so that the numbering of corners does not matter.
      Triangle t = *triangle;
      std::sort(t.begin(), t.end());
      const auto found = sidesAt(point, t);
      if (!found) continue;
      // Inside one side, the next one leads away from it, too. Inside the face, any two do.
      const unsigned rest = std::has_single_bit(*found) ? *found << 1 | *found >> 2 : 0;
      const unsigned sides = *found == 0 ? 3 : *found | rest;
      for (int i = 0; i < 3; ++i) {
        if ((sides >> i & 1) != 0) edges.push_back(std::minmax(t[i], t[next(i)]));
      }
      found_.push_back(*triangle);
    }
    sortOnce(found_);
  }
  bool contains(const TouchingPair& pair) const {
    return std::binary_search(found_.begin(), found_.end(), moving_ ? pair.placed.a : pair.placed.b);
  }

  std::vector<Edge> edges;

 private:
  bool moving_;
  std::vector<Triangle> found_;
};

}  // namespace

Vector contactNormal(const Event& first, const Span& span, std::span<const TouchingPair* const> pairs) {
  // In the order of their names, of which the first is the least: it does not depend on the search.
  std::vector<const TouchingPair*> ordered(pairs.begin(), pairs.end());
  std::sort(ordered.begin(), ordered.end(), [](const auto* p, const auto* q) { return p->name < q->name; });
  const Contacts all(first.direction, span, ordered);
  if (first.kind <= Kind::edgeEdge &&
      all.areApart(Plane(first.direction, {first.x0, first.x1}, {first.y0, first.y1}))) {
    return normal(first);
  }
  if (const auto own = all.own()) return *own;
  const std::pair<Place, Place> places = placesOf(first);
  const auto rimOf = [&](std::span<const TouchingPair* const> some) {
    const Around a(some, true, places.first), b(some, false, places.second);
    std::vector<const TouchingPair*> around;
    for (const TouchingPair* pair : some) {
      if (a.contains(*pair) && b.contains(*pair)) around.push_back(pair);
    }
    std::vector<Edge> edges = a.edges;
    edges.insert(edges.end(), b.edges.begin(), b.edges.end());
    sortOnce(edges);
    return Contacts(first.direction, span, around).rim(edges);
  };
  if (const auto rim = rimOf(ordered)) return *rim;
  return rimOf({ordered.data(), 1}).value();
}

}  // namespace radar::exact
