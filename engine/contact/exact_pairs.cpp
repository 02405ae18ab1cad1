#include "contact/exact_pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "exact/common_point.h"

namespace radar {

namespace {

exact::Triangle corners(const Mesh& mesh, const Transform& pose, uint32_t triangle) {
  exact::Triangle p;
  for (int i = 0; i < 3; ++i)
    p[i] = transformPoint(pose, &mesh.positions[3 * size_t{mesh.indices[3 * size_t{triangle} + i]}]);
  std::sort(p.begin(), p.end());
  return p;
}

}  // namespace

PlacedPair placedPair(const PairName& name, const Query& query, const Scene::Impl& scene) {
  const Object& object = scene.objects[name.object].object;
  return {corners(scene.meshes[query.mesh], query.worldFromMesh, name.triA),
          corners(scene.meshes[object.mesh], object.worldFromMesh, name.triB)};
}

PlacedPair placedPair(const gpu::UnresolvedPair& pair, const Query& query) {
  Transform pose;
  std::copy(std::begin(pair.pose), std::end(pair.pose), pose.m.begin());
  PlacedPair placed;
  for (int i = 0; i < 3; ++i) {
    placed.a[i] = transformPoint(query.worldFromMesh, pair.a[i]);
    placed.b[i] = transformPoint(pose, pair.b[i]);
  }
  std::sort(placed.a.begin(), placed.a.end());
  std::sort(placed.b.begin(), placed.b.end());
  return placed;
}

void setBracket(Result& result, double t, double slack, double distance) {
  result.t = std::min(t, distance);
  result.lo = std::min(std::max(t - slack, 0.0), result.t);
  result.hi = std::min(t + slack, distance);
  result.fraction = distance > 0 ? result.t / distance : 0;
}

bool ExactPairs::earlier(const Decided& p, const Decided& q) {
  if (p.overlap != q.overlap) return p.overlap;
  const int order = p.overlap ? 0 : exact::compare(p.first, q.first);
  return order != 0 ? order < 0 : p.name < q.name;
}

void ExactPairs::consider(const PairName& name, const PlacedPair& pair) {
  const auto interval = exact::contact(pair.a, pair.b, direction_);
  if (!interval || exact::sign(interval->last) < 0) return;
  const Decided decided{name, pair, interval->first, exact::sign(interval->first) <= 0};
  if (!decided.overlap && exact::compareToDistance(decided.first, distance_) > 0) return;
  if (!found_ || earlier(decided, best_)) best_ = decided;
  found_ = true;
}

void ExactPairs::tell(Result& result) const {
  result.object = best_.name.object;
  result.triB = best_.name.triB;
  result.triA = best_.name.triA;
  result.detected = Detected::yes;
  result.status = best_.overlap ? Status::overlap : Status::hit;
  const double s = best_.overlap ? 0 : exact::parameter(best_.first);
  if (!best_.overlap || exact::sign(best_.first) == 0) {
    result.point = exact::point(best_.first, s);
    result.normal = exact::normal(best_.first);
  } else {
    result.point = exact::commonPoint(best_.pair.a, best_.pair.b);
  }
  if (best_.overlap) {
    result.t = result.lo = result.hi = result.fraction = 0;
  } else if (exact::compareToDistance(best_.first, distance_) == 0) {
    setBracket(result, distance_, 0, distance_);
  } else {
    const double length = exact::length(direction_), t = s * length;
    setBracket(result, t, 8 * kDoubleUnit * t + (length + 2) * std::numeric_limits<double>::denorm_min(), distance_);
  }
}

}  // namespace radar
