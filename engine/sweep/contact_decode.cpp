#include "sweep/contact_decode.h"

#include <algorithm>
#include <cmath>

#include "sweep/contact_point.h"
#include "sweep/exact_pairs.h"

namespace radar {

namespace {

PairName nameOf(const gpu::Contender& c, const Query& query, const Scene::Impl& scene) {
  const Mesh& b = scene.meshes[scene.objects[c.object].object.mesh];
  return {c.object, b.clusters.order[c.slotB], scene.meshes[query.mesh].clusters.order[c.slotA]};
}

// The corners of the two parts that attain a contact; what a part lacks repeats its first. Equal features compare
// equal.
std::array<Vector, 6> partsOf(const PlacedPair& pair, uint32_t feature) {
  const auto& [a, b] = pair;
  if (feature < 3) return {a[feature], a[feature], a[feature], b[0], b[1], b[2]};
  if (feature < gpu::kFeatureEdges) return {a[0], a[1], a[2], b[feature - 3], b[feature - 3], b[feature - 3]};
  const uint32_t i = (feature - gpu::kFeatureEdges) / 3, j = (feature - gpu::kFeatureEdges) % 3;
  return {a[kEdgeFrom[i]], a[kEdgeTo[i]], a[kEdgeFrom[i]], b[kEdgeFrom[j]], b[kEdgeTo[j]], b[kEdgeFrom[j]]};
}

// How far off the device may be, relative to the triangle or to what lies before it: an edge that all but runs along
// the motion makes it worse, and the pair is decided exactly.
constexpr double kSharpEnough = 1e-12;

// Longest edge of a triangle's box, in parameters of the direction.
double extentIn(const exact::Triangle& a, const Vector& direction) {
  double extent = 0;
  for (int k = 0; k < 3; ++k) {
    const auto [least, most] = std::minmax({a[0][k], a[1][k], a[2][k]});
    extent = std::max(extent, most - least);
  }
  return extent / lengthOf(scaledDirection(direction));
}

// Whether the device's word stands: every contender surely meets, first where the same two features touch, before D.
bool settled(const Search& search, const Query& query, const Scene::Impl& scene) {
  const gpu::Contender& first = search.contenders[0];
  if ((first.flags & gpu::kContenderSharp) == 0) return false;
  if ((first.at + first.error) * lengthOf(scaledDirection(query.direction)) * (1 + 8 * kDoubleUnit) >= query.distance)
    return false;
  const PlacedPair pair = placedPair(nameOf(first, query, scene), query, scene);
  if (first.error > kSharpEnough * std::max(first.at, extentIn(pair.a, query.direction))) return false;
  if (search.contenders.size() == 1) return true;
  const auto parts = partsOf(pair, first.flags & 0xff);
  return std::all_of(search.contenders.begin() + 1, search.contenders.end(), [&](const gpu::Contender& c) {
    return (c.flags & gpu::kContenderSharp) != 0 && c.at == first.at &&
           partsOf(placedPair(nameOf(c, query, scene), query, scene), c.flags & 0xff) == parts;
  });
}

}  // namespace

Result decodeContact(const Search& found, const Query& query, const Scene::Impl& scene, uint64_t& cpuPairs) {
  // What was kept before `hi` fell to where it is may begin beyond it.
  const double limit = found.state.hi / lengthOf(scaledDirection(query.direction)) * (1 + 8 * kDoubleUnit);
  std::vector<gpu::Contender> kept;
  for (const gpu::Contender& c : found.contenders) {
    if (c.low <= limit) kept.push_back(c);
  }
  const Search search{found.state, kept};
  Result result;
  result.tier = Tier::contact;
  result.status = Status::clear;
  if (search.contenders.empty()) {
    if (found.state.hi < query.distance) throw Error("the contact search lost what it met", VK_ERROR_UNKNOWN);
    return result;
  }

  if (settled(search, query, scene)) {
    const gpu::Contender* best = &search.contenders[0];
    PairName least = nameOf(*best, query, scene);
    for (const gpu::Contender& c : search.contenders.subspan(1)) {
      const PairName name = nameOf(c, query, scene);
      if (name < least) {
        least = name;
        best = &c;
      }
    }
    const double length = lengthOf(scaledDirection(query.direction)), t = best->at * length;
    result.status = Status::hit;
    result.detected = Detected::yes;
    result.object = least.object;
    result.triB = least.triB;
    result.triA = least.triA;
    setBracket(result, t, best->error * length + 8 * kDoubleUnit * t, query.distance);
    const PlacedPair pair = placedPair(least, query, scene);
    describe(result, best->flags & 0xff, pair.a, pair.b, query.direction);
    return result;
  }

  ExactPairs exact(query, scene);
  for (const gpu::Contender& c : search.contenders) exact.consider(nameOf(c, query, scene));
  cpuPairs += search.contenders.size();
  if (exact.found()) {
    exact.tell(result);
  } else if (found.state.hi < query.distance) {
    throw Error("the contact search lost what it met", VK_ERROR_UNKNOWN);
  }
  return result;
}

}  // namespace radar
