// The oracle for pairs of triangles that block: the definition, in exact integers and by another method than the
// engine's. The engine tries the normals of a polyhedron's faces. The oracle looks for any normal whose largest
// component is 1 or -1: on each face of the cube of such normals it clips the face by the conditions on the normal.
#pragma once

#include <algorithm>

#include "exact_oracle.h"

namespace oracle {

namespace detail {

/// A corner (x/w, y/w) of a polygon, w > 0, and the line on which the side to the next corner lies.
struct PolygonCorner {
  IntVec xyw;
  IntVec line;
};

/// Removes from a convex polygon, which may be a segment or a point, all points where f[0] x + f[1] y + f[2] < 0.
inline void clip(std::vector<PolygonCorner>& polygon, const IntVec& f) {
  std::vector<PolygonCorner> out;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const PolygonCorner& p = polygon[i];
    const int u = dot(f, p.xyw).sign(), v = dot(f, polygon[(i + 1) % polygon.size()].xyw).sign();
    if (u >= 0) out.push_back({p.xyw, u == 0 && v < 0 ? f : p.line});
    if (u * v >= 0) continue;
    IntVec between = cross(p.line, f);
    if (between[2] < 0) between = {-between[0], -between[1], -between[2]};
    out.push_back({between, u > 0 ? f : p.line});
  }
  polygon = std::move(out);
}

/// Whether some n with a largest component of 1 or -1 has n . c >= -slack for all c of `differences` and n . d >= 0 for
/// all d of `directions`, and n . d > 0 for `strictly`, if that is given.
inline bool hasNormal(const std::vector<IntVec>& differences, const std::vector<IntVec>& directions,
                      const Integer& slack, const IntVec* strictly = nullptr) {
  for (int face = 0; face < 6; ++face) {
    const int k = face / 2, x = (k + 1) % 3, y = (k + 2) % 3;
    const int side = face % 2 == 0 ? 1 : -1;
    std::vector<PolygonCorner> normals{
        {{-1, -1, 1}, {0, 1, 1}}, {{1, -1, 1}, {-1, 0, 1}}, {{1, 1, 1}, {0, -1, 1}}, {{-1, 1, 1}, {1, 0, 1}}};
    for (const IntVec& d : directions) clip(normals, {d[x], d[y], side * d[k]});
    for (const IntVec& c : differences) clip(normals, {c[x], c[y], side * c[k] + slack});
    const auto suits = [&](const PolygonCorner& n) {
      const IntVec& d = *strictly;
      return dot(IntVec{d[x], d[y], side * d[k]}, n.xyw) > 0;
    };
    if (strictly == nullptr ? !normals.empty() : std::any_of(normals.begin(), normals.end(), suits)) return true;
  }
  return false;
}

inline Integer largest(const IntVec& n) {
  return std::max({Integer(abs(n[0])), Integer(abs(n[1])), Integer(abs(n[2]))});
}

}  // namespace detail

/// A triangle and its normal, which points outwards.
struct Faced {
  IntTriangle corners;
  IntVec normal;
};

inline Faced faced(const IntTriangle& corners, bool isMirrored) {
  const IntVec normal = cross(minus(corners[1], corners[0]), minus(corners[2], corners[0]));
  return {corners, isMirrored ? IntVec{-normal[0], -normal[1], -normal[2]} : normal};
}

/// Whether the triangles are in the plane of either, face each other and overlap, all up to the slack.
inline bool areFlush(const Faced& a, const Faced& b, const Integer& slack) {
  if (dot(a.normal, b.normal) >= 0) return false;
  const auto isThin = [&](const IntVec& n) {
    const Integer allowed = slack * detail::largest(n);
    for (const IntVec& p : a.corners) {
      for (const IntVec& q : b.corners) {
        if (abs(dot(n, minus(p, q))) > allowed) return false;
      }
    }
    return true;
  };
  if (!isThin(a.normal) && !isThin(b.normal)) return false;
  for (const Faced* face : {&a, &b}) {
    for (int i = 0; i < 3; ++i) {
      const IntVec n = cross(face->normal, minus(face->corners[(i + 1) % 3], face->corners[i]));
      for (int side : {-1, 1}) {
        Integer depth = -1;
        for (const IntVec& p : a.corners) {
          for (const IntVec& q : b.corners) depth = std::max(depth, Integer(side * dot(n, minus(p, q))));
        }
        if (depth <= slack * detail::largest(n)) return false;
      }
    }
  }
  return true;
}

inline std::vector<IntVec> differences(const Faced& a, const Faced& b) {
  std::vector<IntVec> out;
  for (const IntVec& p : a.corners) {
    for (const IntVec& q : b.corners) out.push_back(minus(p, q));
  }
  return out;
}

/// How triangle a moves: `distance` times the direction.
struct Course {
  IntVec direction;
  Rational distance;
};

/// The course of a motion by `distance` along a direction of that `length`, past triangles in units of 2^unit.
inline Course courseOf(const Corner& direction, double distance, double length, int unit) {
  const int exponent = leastExponent(direction.data(), 3);
  const int shift = exponent - unit;
  const Rational times = Rational(distance) / Rational(length), power(Integer(Integer(1) << std::abs(shift)));
  return {scaled(direction, exponent), shift < 0 ? Rational(times / power) : Rational(times * power)};
}

/// Whether they are flush, and the motion would sink a into the solid behind b by more than the slack.
inline bool arePressed(const Faced& a, const Faced& b, const Course& course, const Integer& slack) {
  if (!areFlush(a, b, slack)) return false;
  const Integer against = -dot(course.direction, b.normal);
  if (course.distance * against <= Rational(Integer(slack * detail::largest(b.normal)))) return false;
  return !detail::hasNormal(differences(a, b), {course.direction}, slack, &b.normal);
}

/// Whether triangle a, in motion, is blocked by b.
inline bool blocks(const Faced& a, const Faced& b, const Course& course, const Integer& slack) {
  if (areFlush(a, b, slack)) return arePressed(a, b, course, slack);
  return !detail::hasNormal(differences(a, b), {course.direction}, slack);
}

/// Whether the triangles cross by more than the slack.
inline bool cross(const Faced& a, const Faced& b, const Integer& slack) {
  return !detail::hasNormal(differences(a, b), {}, slack);
}

/// Two triangles and the slack on one scale, for the questions above.
struct ScaledPair {
  ScaledPair(const Corners& first, bool mirroredA, const Corners& second, bool mirroredB, double room) {
    std::vector<double> all{room};
    for (const Corners* t : {&first, &second}) {
      for (const Corner& c : *t) all.insert(all.end(), c.begin(), c.end());
    }
    const int scale = leastExponent(all.data(), all.size());
    a = faced(scaled(first, scale), mirroredA);
    b = faced(scaled(second, scale), mirroredB);
    slack = scaled(room, scale);
    unit = scale;
  }
  Faced a, b;
  Integer slack;
  int unit;  ///< exponent of the scale
};

}  // namespace oracle
