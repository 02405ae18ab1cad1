// The oracle for pairs of triangles that block: the definition, in exact rationals and by another method than the
// engine's. The engine tries the normals of a polyhedron's faces. The oracle looks for any normal whose largest
// component is 1 or -1: on each face of the cube of such normals it clips the face by the conditions on the normal.
#pragma once

#include "exact_oracle.h"

namespace oracle {

using RationalVec = std::array<Rational, 3>;

inline RationalVec rationals(const Corner& p) {
  return {Rational(p[0]), Rational(p[1]), Rational(p[2])};
}

inline RationalVec minus(const RationalVec& p, const RationalVec& q) {
  return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}

inline RationalVec cross(const RationalVec& p, const RationalVec& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}

inline Rational dot(const RationalVec& p, const RationalVec& q) {
  return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}

namespace detail {

using Flat = std::array<Rational, 2>;

/// The part of a convex polygon, which may be a segment or a point, where f[0] x + f[1] y + f[2] >= 0.
inline std::vector<Flat> clipped(const std::vector<Flat>& polygon, const RationalVec& f) {
  const auto value = [&](const Flat& p) -> Rational { return f[0] * p[0] + f[1] * p[1] + f[2]; };
  std::vector<Flat> out;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Flat &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const Rational u = value(p), v = value(q);
    if (u >= 0) out.push_back(p);
    if (u.sign() * v.sign() < 0) {
      const Rational w = u / (u - v);
      out.push_back({p[0] + w * (q[0] - p[0]), p[1] + w * (q[1] - p[1])});
    }
  }
  return out;
}

/// Whether some n with a largest component of 1 or -1 has n . c >= -slack for all c of `differences` and n . d >= 0 for
/// all d of `directions`.
inline bool hasNormal(const std::vector<RationalVec>& differences, const std::vector<RationalVec>& directions,
                      const Rational& slack) {
  for (int face = 0; face < 6; ++face) {
    const int k = face / 2, x = (k + 1) % 3, y = (k + 2) % 3;
    const int side = face % 2 == 0 ? 1 : -1;
    std::vector<Flat> normals{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    for (const RationalVec& c : differences) normals = clipped(normals, {c[x], c[y], side * c[k] + slack});
    for (const RationalVec& d : directions) normals = clipped(normals, {d[x], d[y], side * d[k]});
    if (!normals.empty()) return true;
  }
  return false;
}

inline Rational largest(const RationalVec& n) {
  return std::max({Rational(abs(n[0])), Rational(abs(n[1])), Rational(abs(n[2]))});
}

}  // namespace detail

/// A triangle and its normal, which points outwards.
struct Faced {
  std::array<RationalVec, 3> corners;
  RationalVec normal;
};

inline Faced faced(const Corners& corners, bool mirrored) {
  Faced out;
  for (int i = 0; i < 3; ++i) out.corners[i] = rationals(corners[i]);
  out.normal = cross(minus(out.corners[1], out.corners[0]), minus(out.corners[2], out.corners[0]));
  if (mirrored) {
    for (Rational& c : out.normal) c = -c;
  }
  return out;
}

/// Whether the triangles are in the plane of either, face each other and overlap, all up to the slack.
inline bool areFlush(const Faced& a, const Faced& b, const Rational& slack) {
  if (dot(a.normal, b.normal) >= 0) return false;
  const auto isThin = [&](const RationalVec& n) {
    for (const RationalVec& p : a.corners) {
      for (const RationalVec& q : b.corners) {
        if (abs(dot(n, minus(p, q))) > slack * detail::largest(n)) return false;
      }
    }
    return true;
  };
  if (!isThin(a.normal) && !isThin(b.normal)) return false;
  for (const Faced* face : {&a, &b}) {
    for (int i = 0; i < 3; ++i) {
      const RationalVec n = cross(face->normal, minus(face->corners[(i + 1) % 3], face->corners[i]));
      for (int side : {-1, 1}) {
        Rational depth = -1;
        for (const RationalVec& p : a.corners) {
          for (const RationalVec& q : b.corners) depth = std::max(depth, Rational(side * dot(n, minus(p, q))));
        }
        if (depth <= slack * detail::largest(n)) return false;
      }
    }
  }
  return true;
}

inline std::vector<RationalVec> differences(const Faced& a, const Faced& b) {
  std::vector<RationalVec> out;
  for (const RationalVec& p : a.corners) {
    for (const RationalVec& q : b.corners) out.push_back(minus(p, q));
  }
  return out;
}

/// Whether they are flush, and the direction goes against the normal of b.
inline bool arePressed(const Corners& a, bool mirroredA, const Corners& b, bool mirroredB, const Corner& direction,
                       double slack) {
  const Faced p = faced(a, mirroredA), q = faced(b, mirroredB);
  return areFlush(p, q, Rational(slack)) && dot(rationals(direction), q.normal) < 0;
}

/// Whether triangle a, in motion along `direction`, is blocked by b.
inline bool blocks(const Corners& a, bool mirroredA, const Corners& b, bool mirroredB, const Corner& direction,
                   double slack) {
  const Faced p = faced(a, mirroredA), q = faced(b, mirroredB);
  const RationalVec d = rationals(direction);
  if (areFlush(p, q, Rational(slack))) return dot(d, q.normal) < 0;
  return !detail::hasNormal(differences(p, q), {d}, Rational(slack));
}

/// Whether the triangles cross by more than the slack.
inline bool cross(const Corners& a, const Corners& b, double slack) {
  return !detail::hasNormal(differences(faced(a, false), faced(b, false)), {}, Rational(slack));
}

}  // namespace oracle
