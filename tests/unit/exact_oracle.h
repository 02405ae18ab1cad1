// The oracle: whether and when two triangles meet along a direction, in exact integers and by another method than the
// engine's. The engine finds the ends of the contact interval among vertices over faces and crossings of edges. The
// oracle intersects the intervals that separating axes of the difference set b - a allow: for each axis n, min(n.b) -
// max(n.a) <= s n.d <= max(n.b) - min(n.a). Enough axes together describe the set exactly.
#pragma once

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <optional>
#include <vector>

#include "radar/radar.h"

namespace oracle {

using Integer = boost::multiprecision::cpp_int;
using Rational = boost::multiprecision::cpp_rational;
using Corner = std::array<double, 3>;
using Corners = std::array<Corner, 3>;

/// num / den, den > 0, not reduced.
struct Fraction {
  Integer num, den = 1;
  int sign() const { return num.sign(); }
};

inline int compare(const Fraction& p, const Fraction& q) {
  return Integer(p.num * q.den).compare(Integer(q.num * p.den));
}

/// A double is mantissa * 2^exponent. Relative to the least exponent of a set, all its doubles are integers.
inline int leastExponent(const double* values, size_t count) {
  int least = 2000;
  for (size_t i = 0; i < count; ++i) {
    if (values[i] == 0) continue;
    int e;
    std::frexp(values[i], &e);
    least = std::min(least, e - 53);
  }
  return least == 2000 ? 0 : least;
}

inline Integer scaled(double value, int exponent) {
  if (value == 0) return 0;
  int e;
  const double m = std::frexp(value, &e);
  return Integer(static_cast<long long>(std::ldexp(m, 53))) << (e - 53 - exponent);
}

using IntVec = std::array<Integer, 3>;

inline IntVec cross(const IntVec& p, const IntVec& q) {
  return {Integer(p[1] * q[2] - p[2] * q[1]), Integer(p[2] * q[0] - p[0] * q[2]), Integer(p[0] * q[1] - p[1] * q[0])};
}

inline Integer dot(const IntVec& p, const IntVec& q) {
  return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}

inline IntVec minus(const IntVec& p, const IntVec& q) {
  return {Integer(p[0] - q[0]), Integer(p[1] - q[1]), Integer(p[2] - q[2])};
}

inline bool isZero(const IntVec& v) {
  return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

struct Interval {
  Fraction first, last;
};

namespace detail {

inline std::vector<IntVec> axesFor(const std::array<IntVec, 3>& a, const std::array<IntVec, 3>& b) {
  std::vector<IntVec> edges, axes;
  for (int i = 0; i < 3; ++i) edges.push_back(minus(a[(i + 1) % 3], a[i]));
  for (int i = 0; i < 3; ++i) edges.push_back(minus(b[(i + 1) % 3], b[i]));
  axes.push_back(cross(edges[0], edges[1]));
  axes.push_back(cross(edges[3], edges[4]));
  for (int i = 0; i < 3; ++i) {
    for (int k = 3; k < 6; ++k) axes.push_back(cross(edges[i], edges[k]));
  }
  std::erase_if(axes, isZero);
  const bool solid = std::any_of(axes.begin(), axes.end(), [&](const IntVec& n) { return !isZero(cross(n, axes[0])); });
  if (solid) return axes;
  // The difference set is flat, a segment or a point: add axes for its rims within the plane or line, and axes across
  // it.
  const std::vector<IntVec> normals = axes;
  const std::array<IntVec, 3> units{IntVec{1, 0, 0}, IntVec{0, 1, 0}, IntVec{0, 0, 1}};
  for (const IntVec& e : edges) {
    for (const IntVec& n : normals) axes.push_back(cross(e, n));
    for (const IntVec& u : units) axes.push_back(cross(e, u));
    axes.push_back(e);
  }
  for (const IntVec& u : units) axes.push_back(u);
  std::erase_if(axes, isZero);
  return axes;
}

}  // namespace detail

/// The interval of s in which a + s * direction meets b.
inline std::optional<Interval> contact(const Corners& a, const Corners& b, const Corner& direction) {
  std::vector<double> all;
  for (const Corners* t : {&a, &b}) {
    for (const Corner& c : *t) all.insert(all.end(), c.begin(), c.end());
  }
  const int scale = leastExponent(all.data(), all.size()), dirScale = leastExponent(direction.data(), 3);
  std::array<IntVec, 3> p, q;
  IntVec d;
  for (int k = 0; k < 3; ++k) {
    d[k] = scaled(direction[k], dirScale);
    for (int i = 0; i < 3; ++i) {
      p[i][k] = scaled(a[i][k], scale);
      q[i][k] = scaled(b[i][k], scale);
    }
  }
  std::optional<Interval> out;
  for (const IntVec& n : detail::axesFor(p, q)) {
    std::array<Integer, 3> pa{dot(n, p[0]), dot(n, p[1]), dot(n, p[2])}, pb{dot(n, q[0]), dot(n, q[1]), dot(n, q[2])};
    std::sort(pa.begin(), pa.end());
    std::sort(pb.begin(), pb.end());
    Integer lo = pb[0] - pa[2], hi = pb[2] - pa[0], speed = dot(n, d);
    if (speed == 0) {
      if (lo > 0 || hi < 0) return std::nullopt;
      continue;
    }
    if (speed < 0) {
      speed = -speed;
      std::swap(lo, hi);
      lo = -lo;
      hi = -hi;
    }
    const Fraction from{lo, speed}, to{hi, speed};
    if (!out) {
      out = Interval{from, to};
      continue;
    }
    if (compare(from, out->first) > 0) out->first = from;
    if (compare(to, out->last) < 0) out->last = to;
  }
  if (!out || compare(out->first, out->last) > 0) return std::nullopt;
  for (Fraction* f : {&out->first, &out->last}) {
    if (scale >= dirScale) {
      f->num <<= scale - dirScale;
    } else {
      f->den <<= dirScale - scale;
    }
  }
  return out;
}

/// Sign of s * |direction| - distance, for s >= 0 and distance >= 0.
inline int compareToDistance(const Fraction& s, const Corner& direction, double distance) {
  Rational dd = 0;
  for (double c : direction) dd += Rational(c) * Rational(c);
  const Rational t(s.num, s.den);
  return Rational(t * t * dd).compare(Rational(distance) * Rational(distance));
}

struct Answer {
  bool found = false;
  Fraction s;  ///< least parameter, 0 for overlap
  radar::ObjectId object = radar::kNone;
  uint32_t triB = radar::kNone, triA = radar::kNone;
};

inline Corners corners(const radar::MeshView& mesh, const radar::Transform& pose, uint32_t triangle) {
  Corners out;
  for (int i = 0; i < 3; ++i) out[i] = radar::transformPoint(pose, &mesh.positions[3 * mesh.indices[3 * triangle + i]]);
  return out;
}

/// Brute force over all pairs. `counts` and `touches` tell of a placed pair, of the sensor and of the object, whether
/// it counts, and whether it touches at the start though it has parted.
template <class Counts, class Touches>
Answer answer(const radar::Scene& scene, const radar::Query& query, const Counts& counts, const Touches& touches) {
  Answer best;
  const radar::MeshView sensor = scene.mesh(query.mesh);
  for (radar::ObjectId id = 0; id < scene.objectLimit(); ++id) {
    if (!scene.hasObject(id) || (scene.object(id).mask & query.mask) == 0) continue;
    if (std::find(query.exclude.begin(), query.exclude.end(), id) != query.exclude.end()) continue;
    const radar::MeshView mesh = scene.mesh(scene.object(id).mesh);
    for (uint32_t triB = 0; triB < mesh.triangleCount(); ++triB) {
      const Corners b = corners(mesh, scene.object(id).worldFromMesh, triB);
      for (uint32_t triA = 0; triA < sensor.triangleCount(); ++triA) {
        auto interval = contact(corners(sensor, query.worldFromMesh, triA), b, query.direction);
        const Corners a = corners(sensor, query.worldFromMesh, triA);
        const bool parted = !interval || interval->last.sign() < 0;
        if (parted && (best.found && best.s.sign() == 0)) continue;
        if (parted && !touches(id, a, b)) continue;
        Fraction s = parted ? Fraction{} : interval->first;
        if (s.sign() < 0) s = {};
        // The loops visit ids in increasing order, so the first of equals stays.
        if (best.found && compare(s, best.s) >= 0) continue;
        if (compareToDistance(s, query.direction, query.distance) > 0) continue;
        if (!parted && !counts(id, a, b)) continue;
        best = {true, s, id, triB, triA};
      }
    }
  }
  return best;
}

inline Answer answer(const radar::Scene& scene, const radar::Query& query) {
  const auto always = [](radar::ObjectId, const Corners&, const Corners&) { return true; };
  return answer(scene, query, always, [](radar::ObjectId, const Corners&, const Corners&) { return false; });
}

}  // namespace oracle
