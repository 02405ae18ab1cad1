#include "fuzz/check_answers.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "fuzz/target.h"
#include "support/answer.h"
#include "support/same_bits.h"
#include "unit/brute_force.h"
#include "unit/turn_truth.h"
#include "workloads/vectors.h"

namespace radar::fuzz {

namespace {

constexpr size_t kMostPairs = 600;  // of triangles, for brute force

bool isFiniteAt(const MeshView& mesh, const Transform& pose) {
  for (const uint32_t vertex : mesh.indices) {
    for (const double x : transformPoint(pose, &mesh.positions[3 * size_t{vertex}])) {
      if (!std::isfinite(x)) return false;
    }
  }
  return true;
}

bool isForBruteForce(const Scene& scene, const Query& query) {
  const MeshView sensor = scene.mesh(query.mesh);
  if (!isFiniteAt(sensor, query.worldFromMesh)) return false;
  size_t pairs = 0;
  for (ObjectId id = 0; id < scene.objectLimit(); ++id) {
    if (!scene.hasObject(id)) continue;
    const MeshView mesh = scene.mesh(scene.object(id).mesh);
    if (!isFiniteAt(mesh, scene.object(id).worldFromMesh)) return false;
    pairs += size_t{sensor.triangleCount()} * mesh.triangleCount();
  }
  return pairs <= kMostPairs;
}

/// Checks what holds for every exact answer.
void checkContract(const Query& query, const Result& result) {
  const bool met = result.status == Status::hit || result.status == Status::overlap;
  require(result.status != Status::invalid && result.flags == 0, "an answer that is invalid");
  require(result.status != Status::undecided || query.clearance > 0 || query.turn, "an answer that is undecided");
  if (result.status == Status::clear) {
    require(result.lo == INFINITY && result.hi == INFINITY && result.t == INFINITY, "clear, but with times");
  }
  if (!met) return require(result.hi == INFINITY && result.object == kNone, "no contact, but with its object");
  const double end = query.motion || query.turn ? 1 : query.distance;
  require(0 <= result.lo && result.lo <= result.hi && result.hi <= end, "bounds in disorder");
  if (query.anyHit) return require(result.object == kNone && result.lo == 0 && result.hi == end, "a decision");
  require(result.lo <= result.t && result.t <= result.hi, "t is not within the bounds");
  require(result.fraction >= 0 && result.fraction <= 1, "the fraction is not from 0 to 1");
  require(result.status != Status::overlap || result.t == 0, "an overlap after the start");
}

/// What is wrong with an answer to a query with a clearance: that contact would come later than the surfaces'.
std::string faultOfClearance(const oracle::Truth& truth, const Query& query, const Result& result) {
  if (truth.contacts.empty()) return "";
  if (result.status == Status::clear) return "clear, but the surfaces meet";
  if (query.anyHit) return "";
  return oracle::compareToTime(truth.contacts[0], query, result.lo) < 0 ? "the surfaces meet before lo" : "";
}

/// The largest number among the places of a query's sensor and of all objects.
double farthest(const Scene& scene, const Query& query) {
  double most = 0;
  const auto add = [&](const MeshView& mesh, const Transform& pose) {
    const tools::Bounds bounds = tools::boundsOf(mesh, pose);
    for (size_t k = 0; k < 3; ++k) most = std::max({most, std::abs(bounds.low[k]), std::abs(bounds.high[k])});
  };
  if (!scene.mesh(query.mesh).indices.empty()) add(scene.mesh(query.mesh), query.worldFromMesh);
  for (ObjectId id = 0; id < scene.objectLimit(); ++id) {
    if (scene.hasObject(id)) add(scene.mesh(scene.object(id).mesh), scene.object(id).worldFromMesh);
  }
  for (const double x : query.turn->centre) most = std::max(most, std::abs(x));
  for (const double x : query.motion.value_or(std::array<double, 3>{})) most = std::max(most, std::abs(x));
  return most;
}

/// What is wrong with an answer to a query that turns, by exact tests of poses: surfaces cross before lo, or do not
/// meet at hi.
std::string faultOfTurn(const Scene& scene, const Query& query, const Result& result) {
  constexpr int kTimes = 8;
  if (query.skipOverlapping) return "";
  const test::TurnTruth truth(query, scene);
  const double slack = 1e-12 * (1 + std::abs(query.turn->angle)) * farthest(scene, query);
  // What may leave counts once it is deeper than an eighth of the tolerance and twice the slack.
  const double shallow = query.ignoreLeaving ? 1e-6 * farthest(scene, query) + 2 * query.slack.value_or(0) : 0;
  const double free = result.status == Status::clear ? 1 : result.lo;
  for (int k = 0; k <= kTimes && free > 0; ++k) {
    if (truth.meet((1 - 1e-12) * free * k / kTimes, slack + shallow)) return "the surfaces meet before lo";
  }
  const bool isDated = result.hi > 0 && result.hi <= 1 && !query.anyHit;
  return isDated && !truth.meet(result.hi, query.clearance > 0 ? -slack : 0) ? "nothing meets at hi" : "";
}

std::string faultOf(const Scene& scene, const Query& query, const Result& result, std::span<const Result> hits,
                    std::span<const ObjectId> overlapping) {
  if (query.turn) return faultOfTurn(scene, query, result);
  const oracle::Truth truth = oracle::truthOf(scene, query);
  if (query.clearance > 0) return faultOfClearance(truth, query, result);
  if (!query.anyHit) return oracle::faultOf(truth, query, result, hits, overlapping);
  return (result.status == Status::hit) == truth.contacts.empty() ? "a wrong decision" : "";
}

}  // namespace

std::string inWords(const Query& query, const Result& result) {
  std::ostringstream words;
  words << std::hexfloat;
  for (const double x : query.motion ? *query.motion : query.direction) words << " " << x;
  words << (query.motion ? " motion" : " direction") << ", distance " << query.distance << ", clearance "
        << query.clearance << ", anyHit " << query.anyHit << ", ignoreLeaving " << query.ignoreLeaving << "; status "
        << static_cast<uint32_t>(result.status) << ", t " << result.t << ", lo " << result.lo << ", hi " << result.hi
        << ", fraction " << result.fraction << ", object " << result.object << ", flags " << result.flags;
  return words.str();
}

void checkAnswers(const Scene& scene, std::span<const Query> queries, const Answers& answers) {
  require(answers.results.size() == queries.size(), "another number of answers");
  for (size_t i = 0; i < queries.size(); ++i) {
    const Result& result = answers.results[i];
    checkContract(queries[i], result);
    if (!isForBruteForce(scene, queries[i])) continue;
    const Listed& listed = test::listedBy(answers, i);
    const std::string fault = faultOf(scene, queries[i], result, listed.hits, listed.overlapping);
    require(fault.empty(), "query " + std::to_string(i) + ": " + fault + ":" + inWords(queries[i], result));
  }
}

void checkSampled(const Result& sampled, const Result& exact, const std::string& reason) {
  const bool met = exact.status == Status::hit || exact.status == Status::overlap;
  switch (sampled.status) {
    case Status::hit:
    case Status::overlap:
      return require(met && exact.lo <= sampled.hi, "a contact before the first one");
    case Status::clear:
      return require(!met, "clear, but there is contact");
    case Status::undecided:
      return require(!met || sampled.lo <= exact.hi, "contact before lo");
    case Status::invalid:
      return require(!reason.empty(), "invalid without a reason");
  }
}

void requireSame(const Answers& found, const Answers& expected) {
  const std::string difference = test::differenceOf(found, expected, test::sameButTier);
  require(difference.empty(), "answers differ: " + difference);
}

}  // namespace radar::fuzz
