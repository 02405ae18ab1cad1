#include "sampled/decode.h"

#include "contact/exact_pairs.h"
#include "sampled/contact_point.h"

namespace radar {

namespace {

Corners corners(const Mesh& mesh, const Transform& pose, uint32_t triangle) {
  Corners p;
  for (int i = 0; i < 3; ++i)
    p[i] = transformPoint(pose, &mesh.positions[3 * size_t{mesh.indices[3 * size_t{triangle} + i]}]);
  return p;
}

// Within D or not, and nothing else.
Result decisionOf(const Result& found) {
  Result result;
  result.status = found.status == Status::overlap ? Status::hit : found.status;
  result.tier = found.tier;
  result.detected = found.detected;
  result.resolution = found.resolution;
  result.lo = found.lo;
  result.hi = found.hi;
  result.paperMinL = found.paperMinL;
  return result;
}

// What is known to be in the way, by the device alone.
void setFound(Result& result, const gpu::Answer& answer, const Query& query, const Scene::Impl& scene) {
  result.status = answer.hi == 0 ? Status::overlap : Status::hit;
  result.t = result.hi = answer.hi;
  result.fraction = query.distance > 0 ? answer.hi / query.distance : 0;
  result.object = answer.object;
  result.triB = answer.triB;
  result.triA = answer.triA;
  if (result.status == Status::overlap) return;  // the surfaces already cross: no first point of contact
  const Object& object = scene.objects[answer.object].object;
  describe(result, answer.feature, corners(scene.meshes[query.mesh], query.worldFromMesh, answer.triA),
           corners(scene.meshes[object.mesh], object.worldFromMesh, answer.triB), query.direction);
}

}  // namespace

Result decodeClear() {
  Result result;
  result.status = Status::clear;
  result.tier = Tier::select;
  result.detected = Detected::no;
  return result;
}

Result decodeSampled(const gpu::Answer& answer, std::span<const gpu::SampledUnresolved> open, const Query& query,
                     const Scene::Impl& scene, uint32_t resolution, uint64_t& cpuPairs) {
  Result result;
  result.tier = Tier::sampled;
  result.resolution = resolution;
  result.lo = 0;
  result.status = Status::undecided;
  if (answer.object != kNone) setFound(result, answer, query, scene);
  // An unresolved pair can improve on that only if it may meet before.
  ExactPairs exact(query);
  for (const gpu::SampledUnresolved& pair : open.first(answer.unresolvedPairs)) {
    if (answer.object != kNone && pair.low >= answer.hi) continue;
    if (query.anyHit && (answer.object != kNone || exact.found())) break;
    const PairName name{pair.object, pair.triB, pair.triA};
    exact.consider(name, placedPair(name, query, scene));
    ++cpuPairs;
  }
  Result decided;
  if (exact.found()) exact.tell(decided);
  if (exact.found() && (answer.object == kNone || decided.hi < answer.hi)) {
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
