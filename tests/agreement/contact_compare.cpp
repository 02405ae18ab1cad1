#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "agreement/compare.h"
#include "reference/reference.h"
#include "support/test_device.h"

namespace radar::test {

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

Corners cornersOf(const MeshView& mesh, const Pose& pose, uint32_t triangle) {
  Corners corners;
  for (size_t i = 0; i < 3; ++i) {
    corners[i] = place(pose, &mesh.positions[3 * size_t{mesh.indices[3 * size_t{triangle} + i]}]);
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

/// Longest edge of the box around the placed mesh.
double sizeOf(const MeshView& mesh, const Pose& pose) {
  Vector lo{INFINITY, INFINITY, INFINITY}, hi{-INFINITY, -INFINITY, -INFINITY};
  for (uint32_t vertex : mesh.indices) {
    const Vector p = place(pose, &mesh.positions[3 * size_t{vertex}]);
    for (size_t k = 0; k < 3; ++k) {
      lo[k] = std::min(lo[k], p[k]);
      hi[k] = std::max(hi[k], p[k]);
    }
  }
  return std::max({hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]});
}

void checkPointAndNormal(const Scene& scene, const Query& query, const Result& result, const Result& exact) {
  // Where surfaces pierce each other at the start the reference may name a point of the crossing.
  if (result.status == Status::hit) CHECK_FALSE(std::isnan(result.point[0]));
  CHECK(std::isnan(result.normal[0]) == std::isnan(exact.normal[0]));
  const Object& object = scene.object(result.object);
  const double length = lengthOf(query.direction);
  Corners a = cornersOf(scene.mesh(query.mesh), query.worldFromMesh, result.triA);
  const Corners b = cornersOf(scene.mesh(object.mesh), object.worldFromMesh, result.triB);
  const double scale = std::max({largest(a), largest(b), result.t});
  for (Vector& corner : a) corner = plus(corner, query.direction, result.t / length);
  if (!std::isnan(result.point[0])) {
    CHECK(distanceTo(result.point, a) <= 1e-9 * scale);
    CHECK(distanceTo(result.point, b) <= 1e-9 * scale);
  }
  if (!std::isnan(result.normal[0])) {
    CHECK(std::abs(lengthOf(result.normal) - 1) <= 1e-14);
    CHECK(dot(result.normal, query.direction) <= 1e-15 * length);
  }
}

void checkAgreement(const Scene& scene, const Query& query, const Result& result, const Result& exact,
                    ContactTally& tally) {
  ++tally.queries;
  tally.hits += exact.status == Status::hit;
  tally.overlaps += exact.status == Status::overlap;
  tally.clear += exact.status == Status::clear;
  CHECK(uint32_t(result.status) == uint32_t(exact.status));
  CHECK((result.tier == Tier::select || result.tier == Tier::contact));
  CHECK(result.object == exact.object);
  CHECK(result.triB == exact.triB);
  CHECK(result.triA == exact.triA);
  CHECK(result.resolution == 0);
  if (result.status != exact.status) return;
  if (result.status == Status::clear) {
    CHECK((std::isnan(result.t) && std::isnan(result.lo) && std::isnan(result.hi)));
    return;
  }
  CHECK(result.tier == Tier::contact);
  CHECK(result.detected == Detected::yes);
  const double size = std::max(sizeOf(scene.mesh(query.mesh), query.worldFromMesh), exact.t);
  CHECK(std::abs(result.t - exact.t) <= 1e-12 * size);
  CHECK(result.lo <= result.t);
  CHECK(result.t <= result.hi);
  CHECK(result.hi <= query.distance);
  CHECK(result.hi - result.lo <= 1e-9 * size);
  // The reference's own bracket is a few roundings wide.
  CHECK(result.lo <= exact.hi);
  CHECK(exact.lo <= result.hi);
  CHECK(result.fraction == Approx(query.distance > 0 ? exact.t / query.distance : 0).epsilon(1e-9).margin(1e-12));
  if (result.status == Status::overlap) CHECK((result.t == 0 && result.lo == 0 && result.hi == 0));
  if (result.object == exact.object && result.triB == exact.triB && result.triA == exact.triA) {
    checkPointAndNormal(scene, query, result, exact);
  }
}

void compare(const Scene& scene, Sweeper& sweeper, reference::Reference& reference, std::vector<Query> queries,
             const std::vector<std::string>& names, ContactTally& tally) {
  for (Query& query : queries) query.mode = Mode::contact;
  const std::vector<Result> results = sweeper.run(queries);
  const std::vector<Result> exact = reference.run(queries);
  REQUIRE(results.size() == queries.size());
  for (size_t i = 0; i < queries.size(); ++i) {
    INFO("query " << names[i] << ", reference t " << exact[i].t << " of " << queries[i].distance << " object "
                  << exact[i].object << " triB " << exact[i].triB << " triA " << exact[i].triA);
    checkAgreement(scene, queries[i], results[i], exact[i], tally);
  }
}

}  // namespace

ContactTally compareContact(const Scene& scene, std::vector<Query> queries) {
  ContactTally tally;
  Sweeper sweeper(device(), scene);
  reference::Reference reference(scene);
  std::vector<std::string> names;
  for (size_t i = 0; i < queries.size(); ++i) names.push_back(std::to_string(i));
  compare(scene, sweeper, reference, queries, names, tally);
  compareBounded(scene, std::move(queries), 32);
  return tally;
}

ContactTally compareContact(const tools::Workload& workload) {
  ContactTally tally;
  tools::ScenePlayer player(workload);
  Sweeper sweeper(device(), player.scene());
  reference::Reference reference(player.scene());
  for (const tools::Batch& batch : tools::batchesOf(workload)) {
    player.show(batch.scene);
    std::vector<Query> queries;
    std::vector<std::string> names;
    for (uint32_t i : batch.queries) {
      queries.push_back(tools::toQuery(workload.queries[i], Mode::contact));
      names.push_back(workload.queries[i].id);
    }
    compare(player.scene(), sweeper, reference, std::move(queries), names, tally);
  }
  return tally;
}

}  // namespace radar::test
