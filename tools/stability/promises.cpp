#include "stability/promises.h"
#include "workloads/workload.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace radar::tools {

namespace {

using Vector = std::array<double, 3>;
using Corners = std::array<Vector, 3>;

Vector plus(const Vector& x, const Vector& y, double scale) {
  return {x[0] + scale * y[0], x[1] + scale * y[1], x[2] + scale * y[2]};
}

Vector minus(const Vector& x, const Vector& y) {
  return plus(x, y, -1);
}

double dot(const Vector& x, const Vector& y) {
  return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}

double lengthOf(const Vector& x) {
  return std::hypot(x[0], x[1], x[2]);
}

Vector cross(const Vector& x, const Vector& y) {
  return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
}

Corners cornersOf(const MeshView& mesh, const Transform& pose, uint32_t triangle) {
  Corners corners;
  for (size_t i = 0; i < 3; ++i) {
    corners[i] = transformPoint(pose, &mesh.positions[3 * size_t{mesh.indices[3 * size_t{triangle} + i]}]);
  }
  return corners;
}

double distanceToEdge(const Vector& p, const Vector& from, const Vector& to) {
  const Vector edge = minus(to, from), way = minus(p, from);
  const double square = dot(edge, edge);
  const double at = square > 0 ? std::clamp(dot(edge, way) / square, 0.0, 1.0) : 0;
  return lengthOf(plus(way, edge, -at));
}

/// The triangle may be degenerate.
double distanceTo(const Vector& p, const Corners& t) {
  double best = INFINITY;
  for (size_t i = 0; i < 3; ++i) best = std::min(best, distanceToEdge(p, t[i], t[(i + 1) % 3]));
  const Vector n = cross(minus(t[1], t[0]), minus(t[2], t[0]));
  if (lengthOf(n) == 0) return best;
  for (size_t i = 0; i < 3; ++i) {
    if (dot(n, cross(minus(t[(i + 1) % 3], t[i]), minus(p, t[i]))) < 0) return best;
  }
  return std::min(best, std::abs(dot(n, minus(p, t[0]))) / lengthOf(n));
}

double largest(const Corners& corners) {
  double size = 0;
  for (const Vector& corner : corners) {
    for (double c : corner) size = std::max(size, std::abs(c));
  }
  return size;
}

void judgePointAndNormal(const Scene& scene, const Query& query, const Result& result, const Result& exact,
                         Verdict& verdict) {
  const Object& object = scene.object(result.object);
  const double length = lengthOf(query.direction);
  Corners a = cornersOf(scene.mesh(query.mesh), query.worldFromMesh, result.triA);
  const Corners b = cornersOf(scene.mesh(object.mesh), object.worldFromMesh, result.triB);
  const double rounding = 1e-13 * std::max({largest(a), largest(b), result.t});
  for (Vector& corner : a) corner = plus(corner, query.direction, result.t / length);
  if (!std::isnan(result.point[0])) {
    verdict.point = !(distanceTo(result.point, a) <= rounding && distanceTo(result.point, b) <= rounding);
  } else {
    // Where surfaces pierce each other at the start only the reference may name a point of the crossing.
    verdict.point = result.status == Status::hit;
  }
  if (std::isnan(result.normal[0]) != std::isnan(exact.normal[0])) verdict.normal = true;
  if (!std::isnan(result.normal[0])) {
    const bool unit = std::abs(lengthOf(result.normal) - 1) <= 1e-14;
    if (!unit || !(dot(result.normal, query.direction) <= 1e-15 * length)) verdict.normal = true;
  }
}

}  // namespace

std::string Verdict::words() const {
  const std::pair<bool, const char*> wrong[] = {{missed, "missed"},
                                                {falseHit, "false hit"},
                                                {unanswered, "not answered"},
                                                {wrongStatus, "hit for overlap or overlap for hit"},
                                                {wrongPair, "wrong pair"},
                                                {bracket, "bracket violated"},
                                                {late, "t off"},
                                                {point, "point not on both surfaces"},
                                                {normal, "wrong normal"}};
  std::string list;
  for (const auto& [is, name] : wrong) {
    if (is) list.append(list.empty() ? "" : ", ").append(name);
  }
  return list;
}

Verdict judgeContact(const Scene& scene, const Query& query, const Result& result, const Result& exact) {
  Verdict verdict;
  const bool meets = exact.status != Status::clear;
  if (result.status == Status::undecided || result.status == Status::invalid) {
    verdict.unanswered = true;
    return verdict;
  }
  if (result.status == Status::clear) {
    verdict.missed = meets;
    verdict.bracket = !std::isnan(result.t) || !std::isnan(result.lo) || !std::isnan(result.hi);
    return verdict;
  }
  verdict.falseHit = !meets;
  if (!meets) return verdict;
  verdict.wrongStatus = result.status != exact.status || result.detected != Detected::yes;
  verdict.wrongPair =
      result.object != exact.object || result.triB != exact.triB || result.triA != exact.triA || result.resolution != 0;
  const double size = std::max(sensorSize(scene, query), exact.t);
  verdict.error = result.t == exact.t ? 0 : std::abs(result.t - exact.t) / size;
  verdict.late = !(verdict.error <= 1e-9);
  // The reference's own bracket is a few roundings wide.
  verdict.bracket = !(result.lo <= exact.hi && exact.lo <= result.hi && result.lo <= result.t &&
                      result.t <= result.hi && result.hi <= query.distance && result.hi - result.lo <= 1e-9 * size);
  if (result.status == Status::overlap && (result.t != 0 || result.lo != 0 || result.hi != 0)) verdict.bracket = true;
  const double fraction = query.distance > 0 ? exact.t / query.distance : 0;
  if (!(std::abs(result.fraction - fraction) <= 1e-9)) verdict.late = true;
  if (!verdict.wrongPair) judgePointAndNormal(scene, query, result, exact, verdict);
  return verdict;
}

Verdict judgeSampled(const Query& query, const Result& result, const Result& exact) {
  Verdict verdict;
  const bool contact = exact.status == Status::hit || exact.status == Status::overlap;
  const bool found = result.status == Status::hit || result.status == Status::overlap;
  verdict.missed = contact && result.status == Status::clear;
  verdict.falseHit = found && !contact;
  verdict.unanswered = result.status == Status::invalid;
  if (result.status == Status::clear || verdict.unanswered) return verdict;
  verdict.wrongStatus = (result.status == Status::overlap && exact.status != Status::overlap) ||
                        (found && result.detected != Detected::yes);
  // The reference's own bracket is a few roundings wide.
  const bool high = found ? result.hi >= exact.lo && result.hi <= query.distance : std::isnan(result.hi);
  verdict.bracket = result.lo != 0 || !high || !(query.anyHit || !found || result.t == result.hi);
  return verdict;
}

}  // namespace radar::tools
