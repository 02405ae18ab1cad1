#include "contact/decode.h"

#include <algorithm>
#include <atomic>
#include <tuple>

#include "cpu/clearance.h"
#include "exact/blocking.h"
#include "query/cancelled.h"
#include "query/course.h"
#include "scene/parallel.h"

namespace radar {

namespace {

// Whether the CPU is to decide the search's pairs.
bool isLeft(const Result& found) {
  return found.flags == Flag::unresolved || found.status == Status::overlap;
}

using Pairs = std::span<const gpu::UnresolvedPair* const>;

// By (search, object, triB, triA).
std::vector<const gpu::UnresolvedPair*> ordered(std::span<const gpu::UnresolvedPair> pairs) {
  std::vector<const gpu::UnresolvedPair*> all;
  all.reserve(pairs.size());
  for (const gpu::UnresolvedPair& pair : pairs) {
    if (pair.search != gpu::kNobody) all.push_back(&pair);
  }
  const auto name = [](const gpu::UnresolvedPair* p) { return std::tie(p->search, p->object, p->triB, p->triA); };
  std::sort(all.begin(), all.end(), [&](const auto* p, const auto* q) { return name(p) < name(q); });
  return all;
}

std::vector<Pairs> bySearch(Pairs all) {
  std::vector<Pairs> parts;
  for (auto first = all.begin(); first != all.end();) {
    const auto end = std::find_if(first, all.end(), [&](const auto* p) { return p->search != (*first)->search; });
    parts.emplace_back(first, end);
    first = end;
  }
  return parts;
}

Transform poseOf(const gpu::UnresolvedPair& pair) {
  Transform worldFromObject;
  std::copy(std::begin(pair.pose), std::end(pair.pose), worldFromObject.m.begin());
  return worldFromObject;
}

exact::PlacedPair placedPair(const gpu::UnresolvedPair& pair, const Query& query) {
  const Transform worldFromObject = poseOf(pair);
  exact::PlacedPair placed;
  for (int i = 0; i < 3; ++i) {
    placed.a[i] = transformPoint(query.worldFromMesh, pair.a[i]);
    placed.b[i] = transformPoint(worldFromObject, pair.b[i]);
  }
  return placed;
}

cpu::PairRule ruleFor(const gpu::UnresolvedPair& pair, const Query& query, std::span<const Vector> farthest) {
  if (!query.ignoreLeaving) return {};
  const Transform worldFromObject = poseOf(pair);
  const double greatest = std::max(placedMagnitude(farthest[query.mesh], query.worldFromMesh),
                                   placedMagnitude(farthest[pair.mesh], worldFromObject));
  return {query.slack.value_or(exact::defaultSlack(greatest)),
          {exact::isMirroring(query.worldFromMesh), exact::isMirroring(worldFromObject)}};
}

// `finder`: as of the CPU's search, about to begin.
template <class Finder>
Result decideBy(Finder&& finder, Pairs pairs, const Query& query, const Translation& motion,
                std::span<const Vector> farthest) {
  for (const gpu::UnresolvedPair* pair : pairs) {
    finder.beginObject(ruleFor(*pair, query, farthest), motion);
    finder.consider({pair->object, pair->triB, pair->triA}, placedPair(*pair, query), 0);
    if (finder.isDecided()) break;
  }
  Result result = finder.first();
  result.tier = Tier::contact;
  return result;
}

Result decide(const OpenSearch& open, Pairs pairs, std::span<const Vector> farthest) {
  const auto& [found, query, motion, tolerance] = open;
  if (query.clearance > 0) {
    const Result result = decideBy(cpu::ClearanceContact(query, motion, tolerance), pairs, query, motion, farthest);
    if (result.status != Status::overlap) return result;
    // Only the CPU's search names the nearest pair.
    Result unnamed(Status::overlap);
    unnamed.tier = Tier::contact;
    unnamed.detected = Detected::yes;
    unnamed.t = unnamed.lo = unnamed.hi = unnamed.fraction = 0;
    return unnamed;
  }
  const Result result = decideBy(cpu::FirstContact(query, motion), pairs, query, motion, farthest);
  if (result.status == Status::clear && found.detected == Detected::yes) {
    throw Error(Error::Kind::internal, "the contact search lost a certain contact");
  }
  return result;
}

}  // namespace

uint64_t decideAll(std::span<const gpu::UnresolvedPair> pairs, const Deciding& how,
                   const std::function<OpenSearch(uint32_t search, ObjectId object)>& ask) {
  const auto all = ordered(pairs);
  const std::vector<Pairs> searches = bySearch(all);
  std::atomic<uint64_t> decided = 0;
  parallelFor(searches.size(), 16, how.threads, [&](unsigned, size_t first, size_t last) {
    for (size_t k = first; k < last; ++k) {
      throwIfStopped(how.stop);
      const Pairs own = searches[k];
      if (own.size() > how.most) continue;
      const OpenSearch open = ask(own.front()->search, own.front()->object);
      if (!isLeft(open.result)) continue;
      open.result = decide(open, own, how.farthest);
      decided += own.size();
    }
  });
  return decided;
}

Result clearAnswer() {
  Result result(Status::clear);
  result.tier = Tier::contact;
  return result;
}

namespace {

// Whether what a search found is its answer; else only the CPU can tell.
bool isSettled(const Query& query, double tolerance, const Result& found) {
  if (found.flags != 0 || found.status == Status::invalid) return false;
  if (query.clearance > 0) {
    // The CPU finds the nearest pair of triangles at the start.
    if (found.status == Status::overlap && found.object == kNone) return false;
    // What is certain on the device may have kept the search from other pairs.
    if (found.status == Status::undecided) return false;
    // In a bracket that rounding keeps wide, other pairs may begin than those that the CPU's search comes across.
    if (found.status == Status::hit && !query.anyHit && !(found.hi - found.lo <= tolerance)) return false;
  }
  // What meets at the start may cross, and then takes no part.
  const bool mayCross = found.status == Status::overlap || (query.anyHit && found.status == Status::hit);
  return !(query.skipOverlapping && mayCross);
}

}  // namespace

bool answerFrom(std::span<const Result> searches, const Query& query, const Scene::Impl& scene, Result& answer,
                std::vector<Result>& hits) {
  const double tolerance = cpu::toleranceOf(query, scene.meshes[query.mesh]);
  const auto settled = [&](const Result& found) { return isSettled(query, tolerance, found); };
  const auto decides = [&](const Result& found) { return settled(found) && found.status != Status::clear; };
  const Course course(query, scene);
  // One contact settles a decision, whatever the other searches have found.
  const auto deciding = query.anyHit ? std::ranges::find_if(searches, decides) : searches.end();
  if (deciding != searches.end()) {
    answer = *deciding;
  } else if (!std::ranges::all_of(searches, settled)) {
    return false;
  } else if (searches.size() == 1 && query.hits == 1) {
    answer = searches[0];
  } else {
    Merged all = merged(searches, query.hits);
    if (!all.isCertain) return false;
    answer = all.first;
    if (query.hits > 1) hits = std::move(all.hits);
    for (Result& hit : hits) course.toQuery(hit);
  }
  course.toQuery(answer);
  return true;
}

}  // namespace radar
