#include "sampled/decode.h"

#include <algorithm>

#include "exact/earliest_contact.h"
#include "sampled/contact_point.h"

namespace radar {

namespace {

exact::Triangle sortedTriangle(const Mesh& mesh, const Transform& worldFromMesh, uint32_t triangle) {
  exact::Triangle corners = placedTriangle(mesh, worldFromMesh, triangle);
  std::sort(corners.begin(), corners.end());
  return corners;
}

// Reduces an answer to the decision whether contact is within D.
Result decisionOf(const Result& found) {
  Result result(found.status == Status::overlap ? Status::hit : found.status);
  result.tier = found.tier;
  result.detected = found.detected;
  result.resolution = found.resolution;
  result.lo = found.lo;
  result.hi = found.hi;
  result.paperMinL = found.paperMinL;
  return result;
}

// Sets the contact that the device found.
void setFound(Result& result, const gpu::Answer& answer, const Query& query, const Scene::Impl& scene) {
  result.status = answer.hi == 0 ? Status::overlap : Status::hit;
  result.t = result.hi = answer.hi;
  result.fraction = query.distance > 0 ? answer.hi / query.distance : 0;
  result.object = answer.object;
  result.triB = answer.triB;
  result.triA = answer.triA;
  if (result.status == Status::overlap) return;  // the surfaces already cross, so there is no first point of contact
  const Object& object = scene.objects[answer.object].object;
  describe(result, answer.feature, placedTriangle(scene.meshes[query.mesh], query.worldFromMesh, answer.triA),
           placedTriangle(scene.meshes[object.mesh], object.worldFromMesh, answer.triB), query.direction);
}

}  // namespace

Result decodeClear() {
  Result result(Status::clear);
  result.tier = Tier::select;
  result.detected = Detected::no;
  return result;
}

Result decodeSampled(const gpu::Answer& answer, std::span<const gpu::SampledUnresolved> unresolved, const Query& query,
                     const Scene::Impl& scene, uint32_t resolution, uint64_t& cpuPairs) {
  Result result(Status::undecided);
  result.tier = Tier::sampled;
  result.resolution = resolution;
  result.lo = 0;
  if (answer.object != kNone) setFound(result, answer, query, scene);
  // An unresolved pair matters only if it may meet before that contact.
  const Motion motion(query);
  exact::EarliestContact earliest(motion);
  for (const gpu::SampledUnresolved& pair : unresolved.first(answer.unresolvedPairs)) {
    if (answer.object != kNone && pair.low >= answer.hi) continue;
    if (query.anyHit && (answer.object != kNone || earliest.found())) break;
    const Object& object = scene.objects[pair.object].object;
    earliest.consider({pair.object, pair.triB, pair.triA},
                      {sortedTriangle(scene.meshes[query.mesh], query.worldFromMesh, pair.triA),
                       sortedTriangle(scene.meshes[object.mesh], object.worldFromMesh, pair.triB)});
    ++cpuPairs;
  }
  Result decided = earliest.answer(false);
  if (earliest.found() && (answer.object == kNone || decided.hi < answer.hi)) {
    decided.tier = Tier::sampled;
    decided.resolution = resolution;
    decided.lo = 0;
    decided.t = decided.hi;
    result = decided;
  }
  result.detected = (answer.flags & gpu::kAnswerDetected) != 0 ? Detected::yes : Detected::no;
  if ((answer.flags & gpu::kAnswerHasL) != 0) result.paperMinL = answer.minL;
  return query.anyHit ? decisionOf(result) : result;
}

}  // namespace radar
