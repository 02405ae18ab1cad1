#include "measure/judge.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "workloads/same_answer.h"
#include "workloads/vectors.h"
#include "workloads/workload.h"

namespace radar::tools {

namespace {

using Corners = std::array<Vec3, 3>;

double length(const Vec3& v) {
  return std::hypot(v[0], v[1], v[2]);
}

Vec3 cross(const Vec3& x, const Vec3& y) {
  return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
}

Corners cornersOf(const MeshView& mesh, const Transform& pose, uint32_t triangle) {
  Corners corners;
  for (size_t i = 0; i < 3; ++i) {
    corners[i] = transformPoint(pose, &mesh.positions[3 * size_t{mesh.indices[3 * size_t{triangle} + i]}]);
  }
  return corners;
}

double distanceToEdge(const Vec3& p, const Vec3& from, const Vec3& to) {
  const Vec3 edge = to - from, way = p - from;
  const double square = dot(edge, edge);
  const double at = square > 0 ? std::clamp(dot(edge, way) / square, 0.0, 1.0) : 0;
  return length(way - at * edge);
}

/// The triangle may be degenerate.
double distanceTo(const Vec3& p, const Corners& t) {
  double best = INFINITY;
  for (size_t i = 0; i < 3; ++i) best = std::min(best, distanceToEdge(p, t[i], t[(i + 1) % 3]));
  const Vec3 n = cross(t[1] - t[0], t[2] - t[0]);
  if (length(n) == 0) return best;
  for (size_t i = 0; i < 3; ++i) {
    if (dot(n, cross(t[(i + 1) % 3] - t[i], p - t[i])) < 0) return best;
  }
  return std::min(best, std::abs(dot(n, p - t[0])) / length(n));
}

double largest(const Corners& corners) {
  double size = 0;
  for (const Vec3& corner : corners) {
    for (double c : corner) size = std::max(size, std::abs(c));
  }
  return size;
}

void judgePoint(const Scene& scene, const Query& query, const Result& result, Verdict& verdict) {
  if (std::isnan(result.point[0])) {
    // Where surfaces pierce each other at the start only the exact search may name a point of the crossing.
    verdict.set(Fault::point, result.status == Status::hit);
    return;
  }
  const Object& object = scene.object(result.object);
  Corners a = cornersOf(scene.mesh(query.mesh), query.worldFromMesh, result.triA);
  const Corners b = cornersOf(scene.mesh(object.mesh), object.worldFromMesh, result.triB);
  const double rounding = 1e-13 * std::max({largest(a), largest(b), result.t});
  for (Vec3& corner : a) corner = corner + result.t / length(query.direction) * query.direction;
  verdict.set(Fault::point, !(distanceTo(result.point, a) <= rounding && distanceTo(result.point, b) <= rounding));
}

void judgeNormal(const Query& query, const Result& result, const Result& exact, Verdict& verdict) {
  verdict.set(Fault::normal, std::isnan(result.normal[0]) != std::isnan(exact.normal[0]));
  if (std::isnan(result.normal[0])) return;
  const bool isUnit = std::abs(length(result.normal) - 1) <= 1e-14;
  const bool isAgainst = dot(result.normal, query.direction) <= 1e-15 * length(query.direction);
  verdict.set(Fault::normal, !isUnit || !isAgainst);
}

/// An answer that tells of a contact, in mode contact.
void judgeWhole(const Scene& scene, const Query& query, const Result& result, const Result& exact, double unit,
                Verdict& verdict) {
  verdict.set(Fault::wrongStatus, result.status != exact.status);
  verdict.set(Fault::wrongPair, result.object != exact.object || result.triB != exact.triB ||
                                    result.triA != exact.triA || result.resolution != 0);
  verdict.set(Fault::wrongPair, result.featureA != exact.featureA || result.featureB != exact.featureB);
  // The exact answer's own bracket is a few roundings wide.
  verdict.set(Fault::bracket,
              !(result.lo <= result.t && result.t <= result.hi && result.hi - result.lo <= 1e-9 * unit));
  const bool atStart = result.t == 0 && result.lo == 0 && result.hi == 0;
  verdict.set(Fault::bracket, result.status == Status::overlap && !atStart);
  const double fraction = query.distance > 0 ? exact.t / query.distance : 0;
  verdict.set(Fault::late, !(std::abs(verdict.error) <= 1e-9 && std::abs(result.fraction - fraction) <= 1e-9));
  if (verdict[Fault::wrongPair]) return;
  judgePoint(scene, query, result, verdict);
  judgeNormal(query, result, exact, verdict);
}

/// An answer that tells whether there is a contact, and nothing else of it.
void judgeDecision(const Result& result, Verdict& verdict) {
  verdict.set(Fault::wrongStatus, result.status == Status::overlap);
  verdict.set(Fault::late, result.t != result.hi || result.fraction != (result.hi > 0 ? 1 : 0));
  verdict.set(Fault::wrongPair, result.object != kNone || result.triA != kNone || result.triB != kNone);
  verdict.set(Fault::wrongPair, result.featureA != Feature::none || result.featureB != Feature::none);
  verdict.set(Fault::point, !std::isnan(result.point[0]));
  verdict.set(Fault::normal, !std::isnan(result.normal[0]));
}

void judgeSampled(const Result& result, const Result& exact, Verdict& verdict) {
  if (result.status == Status::clear) return;
  verdict.set(Fault::bracket, result.lo != 0);
  if (!meets(result)) return verdict.set(Fault::bracket, result.hi != INFINITY);
  verdict.set(Fault::wrongStatus, result.status == Status::overlap && exact.status != Status::overlap);
  verdict.set(Fault::bracket, result.t != result.hi);
}

}  // namespace

bool meets(const Result& result) {
  return result.status == Status::hit || result.status == Status::overlap;
}

const char* nameOf(Fault fault) {
  constexpr std::array<const char*, kFaults> kNames{"missed",     "false hit",  "not answered", "wrong status",
                                                    "wrong pair", "wrong list", "bracket",      "late",
                                                    "point",      "normal"};
  return kNames[static_cast<size_t>(fault)];
}

std::string Verdict::words() const {
  std::string list;
  for (size_t i = 0; i < kFaults; ++i) {
    if (faults_[i]) list.append(list.empty() ? "" : ", ").append(nameOf(static_cast<Fault>(i)));
  }
  return list;
}

Verdict judge(const Result& result, const Result& exact, double unit) {
  if (result.status == Status::invalid) throw Error("a query was not answered");
  Verdict verdict;
  const bool contact = meets(exact);
  verdict.set(Fault::missed, contact && result.status == Status::clear);
  verdict.set(Fault::falseHit, !contact && meets(result));
  verdict.unseen = contact && result.status == Status::undecided;
  verdict.found = contact && meets(result);
  if (!verdict.found) return verdict;
  verdict.set(Fault::bracket, result.lo > exact.hi || result.hi < exact.lo);
  if (result.t != exact.t && !std::isnan(result.t)) verdict.error = (result.t - exact.t) / unit;
  return verdict;
}

double unitOf(const Scene& scene, const Query& query, const Result& exact) {
  return std::max(sensorSize(scene, query), meets(exact) ? exact.t : 0);
}

Verdict judgeByBits(const Result& result, const Result& exact) {
  Verdict verdict;
  verdict.set(Fault::missed, meets(exact) && result.status == Status::clear);
  verdict.set(Fault::falseHit, exact.status == Status::clear && meets(result));
  verdict.set(Fault::wrongStatus, result.status != exact.status || result.detected != exact.detected);
  verdict.set(Fault::bracket, result.lo != exact.lo || result.hi != exact.hi);
  verdict.set(Fault::wrongPair, !sameAnswer(result, exact));
  verdict.found = meets(exact) && meets(result);
  return verdict;
}

Verdict judge(const Scene& scene, const Query& query, Mode mode, const Result& result, const Result& exact) {
  Verdict verdict;
  if (result.status == Status::invalid) {
    verdict.set(Fault::unanswered);
    return verdict;
  }
  if (query.clearance > 0) return judgeByBits(result, exact);
  const double unit = unitOf(scene, query, exact);
  verdict = judge(result, exact, unit);
  if (query.anyHit) verdict.error = 0;  // nobody looked for the first contact
  const bool sampled = mode == Mode::sampled;
  if (result.status == Status::clear) {
    verdict.set(Fault::bracket, !sampled && std::min({result.t, result.lo, result.hi}) != INFINITY);
  }
  if (!sampled) verdict.set(Fault::unanswered, result.status == Status::undecided);
  if (verdict.found) {
    // No bound may be absent or beyond D.
    verdict.set(Fault::bracket, !(result.lo <= exact.hi && exact.lo <= result.hi && result.hi <= query.distance));
    verdict.set(Fault::wrongStatus, result.detected != Detected::yes);
    if (query.anyHit) judgeDecision(result, verdict);
    if (!sampled && !query.anyHit) judgeWhole(scene, query, result, exact, unit, verdict);
  }
  if (sampled) judgeSampled(result, exact, verdict);
  return verdict;
}

void Tally::add(const Verdict& verdict, const Result& exact) {
  ++queries;
  hits += exact.status == Status::hit;
  clear += exact.status == Status::clear;
  overlaps += exact.status == Status::overlap;
  unseen += verdict.unseen;
  wrong += !verdict.right();
  for (size_t i = 0; i < kFaults; ++i) faults[i] += verdict[static_cast<Fault>(i)];
  late = std::max(late, verdict.error);
  early = std::max(early, -verdict.error);
}

void Tally::add(const Tally& other) {
  for (uint64_t Tally::*number : {&Tally::queries, &Tally::hits, &Tally::clear, &Tally::overlaps, &Tally::unseen,
                                  &Tally::wrong, &Tally::pairs, &Tally::cpuPairs}) {
    this->*number += other.*number;
  }
  for (size_t i = 0; i < kFaults; ++i) faults[i] += other.faults[i];
  late = std::max(late, other.late);
  early = std::max(early, other.early);
  deviceSeconds += other.deviceSeconds;
  cpuSeconds += other.cpuSeconds;
}

}  // namespace radar::tools
