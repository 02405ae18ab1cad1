// Compares the CPU's search with brute force over all pairs in exact arithmetic.
#include "distances.h"
#include "judged.h"
#include "scene_kinds.h"
#include "support/catch.h"

using namespace radar;
using tools::operator+;
using tools::operator-;
using tools::operator*;

namespace {

/// What is wrong with the point of an answer that names a corner, which is given exactly; empty if nothing is.
std::string faultOfCorner(const Scene& scene, const Query& query, const Result& result) {
  const bool isSensors = query.clearance == 0 && result.featureA == Feature::vertex;
  if (result.featureB != Feature::vertex && !isSensors) return "";
  if (std::isnan(result.point[0])) return "no corner";
  const Object& object = scene.object(result.object);
  if (result.featureB == Feature::vertex && object.motion == tools::Vec3{}) {
    const oracle::Corners b = oracle::corners(scene.mesh(object.mesh), object.worldFromMesh, result.triB);
    return std::ranges::count(b, result.point) > 0 ? "" : "not the corner of the object";
  }
  if (!isSensors || query.motion) return "";
  double most = 0, size = 0, nearest = INFINITY;
  for (const double c : query.direction) most = std::max(most, std::abs(c));
  tools::Vec3 unit = query.direction;
  for (double& c : unit) c /= most;
  unit = 1 / tools::lengthOf(unit) * unit;
  for (const tools::Vec3& corner : oracle::corners(scene.mesh(query.mesh), query.worldFromMesh, result.triA)) {
    const tools::Vec3 off = corner + result.t * unit - result.point;
    nearest = std::min(nearest, std::max({std::abs(off[0]), std::abs(off[1]), std::abs(off[2])}));
    for (const double c : corner) size = std::max(size, std::abs(c));
  }
  for (const double c : result.point) size = std::max(size, std::abs(c));
  return nearest <= 4e-16 * (size + result.t) ? "" : "not the sensor's corner";
}

/// What is wrong with the point of an answer.
std::string faultOfPoint(const Scene& scene, const Query& query, const Result& result, double mostOff) {
  if (result.status != Status::hit && result.status != Status::overlap) return "";
  if (std::string fault = faultOfCorner(scene, query, result); !fault.empty() || query.clearance > 0) return fault;
  if (std::isnan(result.point[0])) return "no point";
  // What is pressed together may have sunk in.
  const double sunk = query.ignoreLeaving ? 4 * query.slack.value_or(0) : 0;
  const double most = result.status == Status::hit ? 1e-13 : mostOff + sunk;
  return distances::offFromBoth(scene, query, result) <= most ? "" : "a point off its triangles";
}

/// Judges the answers about so many scenes of a kind, `varied` or as the kind asks.
oracle::Judged judged(const kinds::Kind& kind, uint64_t scenes, bool varied) {
  oracle::Judged all;
  for (uint64_t seed = 0; seed < scenes; ++seed) {
    kinds::Random random(seed + (varied ? 100'000 : 0));
    test::Case one;
    kind.make(random, one);
    for (Query& query : one.queries) {
      if (varied) kinds::vary(random, query);
    }
    const Answers answers = CpuSweeper(one.scene, 2).run(one.queries);
    for (size_t i = 0; i < one.queries.size(); ++i) {
      const size_t before = all.faults.size();
      const Query& query = one.queries[i];
      if (query.clearance == 0) all.add(one.scene, query, answers, i);
      all.count(faultOfPoint(one.scene, query, answers.results[i], kind.off));
      if (all.faults.size() != before) UNSCOPED_INFO("a fault in scene " << seed << ", query " << i);
    }
  }
  UNSCOPED_INFO(kind.name << (varied ? ", varied: " : ": ") << all.words());
  CHECK(all.faults.empty());
  return all;
}

}  // namespace

TEST_CASE("the CPU's answers, their lists, points and normals are those of brute force, about every kind of scene") {
  for (const kinds::Kind& kind : kinds::all()) {
    const oracle::Judged plain = judged(kind, kind.judged, false);
    CAPTURE(kind.name, plain.words());
    CHECK(plain.hits + plain.overlaps >= kind.contacts);
    judged(kind, kind.judged / 2, true);
  }
}

TEST_CASE("where everything moves, 100,000 answers are those of brute force", "[.long]") {
  for (const kinds::Kind& kind : kinds::all()) {
    if (std::string_view(kind.name).starts_with("steps")) judged(kind, 16'667, false);
  }
}
