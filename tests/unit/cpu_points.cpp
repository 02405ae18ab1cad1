// Points of contact: a corner that touches is given exactly, at every scale and with a clearance, too.
#include "distances.h"
#include "normal_scenes.h"

using namespace radar;
using normals::Case;
using soups::Random;

namespace {

using Vector = std::array<double, 3>;

/// What is wrong with the point of an answer, if it names a corner; empty if nothing is.
std::string faultOf(const Scene& scene, const Query& query, const Result& result) {
  const Object& object = scene.object(result.object);
  const oracle::Corners b = oracle::corners(scene.mesh(object.mesh), object.worldFromMesh, result.triB);
  if (result.featureB == Feature::vertex) {
    return std::find(b.begin(), b.end(), result.point) != b.end() ? "" : "not the corner of the object";
  }
  if (query.clearance > 0 || result.featureA != Feature::vertex) return "";
  double most = 0, size = 0;
  for (const double c : query.direction) most = std::max(most, std::abs(c));
  Vector unit = query.direction;
  for (double& c : unit) c /= most;
  const double length = std::hypot(unit[0], unit[1], unit[2]);
  double nearest = INFINITY;
  for (const Vector& corner : oracle::corners(scene.mesh(query.mesh), query.worldFromMesh, result.triA)) {
    double off = 0;
    for (size_t k = 0; k < 3; ++k) {
      off = std::max(off, std::abs(corner[k] + result.t * (unit[k] / length) - result.point[k]));
      size = std::max({size, std::abs(corner[k]), std::abs(result.point[k])});
    }
    nearest = std::min(nearest, off);
  }
  return nearest <= 4e-16 * (size + result.t) ? "" : "not the sensor's corner";
}

/// How many points are corners, and how many of those are wrong.
struct Points {
  int corners = 0, absent = 0;
  std::map<std::string, int> faults;

  void add(const Scene& scene, const Query& query, const Result& result) {
    if (result.status != Status::hit && result.status != Status::overlap) return;
    const bool isCorner = result.featureB == Feature::vertex || result.featureA == Feature::vertex;
    corners += isCorner;
    absent += isCorner && std::isnan(result.point[0]);
    if (const std::string fault = faultOf(scene, query, result); !fault.empty()) ++faults[fault];
  }
  std::string words() const {
    std::string text = std::to_string(corners) + " corners, " + std::to_string(absent) + " absent";
    for (const auto& [fault, count] : faults) text += "; " + std::to_string(count) + " times: " + fault;
    return text;
  }
};

/// The scene scaled, then moved along x and y.
void place(Case& one, double scale, double far) {
  const auto placed = [&](Transform pose) {
    for (double& c : pose.m) c *= scale;
    pose.m[3] += far;
    pose.m[7] -= far / 3;
    return pose;
  };
  for (ObjectId id = 0; id < one.scene.objectLimit(); ++id) {
    one.scene.setTransform(id, placed(one.scene.object(id).worldFromMesh));
  }
  for (Query& query : one.queries) {
    query.worldFromMesh = placed(query.worldFromMesh);
    query.distance *= 10 * scale;
  }
}

}  // namespace

TEST_CASE("a corner that touches is the point of contact, at every scale and far from the origin") {
  for (const auto& [scale, far] : {std::pair{1.0, 0.0}, {1.1, 4000.0}, {1e-151, 0.0}, {1e151, 0.0}, {1e200, 0.0}}) {
    for (const bool isFlat : {false, true}) {
      Points points;
      for (uint64_t seed = 0; seed < 300; ++seed) {
        Random random(seed);
        Case one;
        normals::lattices(random, isFlat, one);
        place(one, scale, far);
        if (random.chance(0.3)) {
          for (Query& query : one.queries) query.clearance = scale * random.uniform(0.01, 0.5);
        }
        const std::vector<Result> results = CpuSweeper(one.scene, 1).run(one.queries).results;
        for (size_t q = 0; q < results.size(); ++q) points.add(one.scene, one.queries[q], results[q]);
      }
      CAPTURE(scale, far, isFlat);
      INFO(points.words());
      CHECK(points.faults.empty());
      CHECK(points.absent == 0);
      CHECK(points.corners > 200);
    }
  }
}

TEST_CASE("edges cross at a point on both, also where products of their coordinates overflow or underflow") {
  for (const double scale : {1e-200, 1e-151, 1e-100, 1e100, 1e151, 1e200}) {
    size_t crossings = 0;
    for (uint64_t seed = 0; seed < 40; ++seed) {
      Random random(seed);
      Case one;
      normals::floats(random, 1, one);
      place(one, scale, 0);
      const std::vector<Result> results = CpuSweeper(one.scene, 1).run(one.queries).results;
      for (size_t q = 0; q < results.size(); ++q) {
        const Result& result = results[q];
        if (result.featureA != Feature::edge || result.featureB != Feature::edge) continue;
        ++crossings;
        CAPTURE(scale, seed, q);
        CHECK(distances::offFromBoth(one.scene, one.queries[q], result) <= 1e-14);
      }
    }
    CHECK(crossings > 5);
  }
}
