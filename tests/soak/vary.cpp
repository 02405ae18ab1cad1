#include "soak/vary.h"

#include <cmath>

#include "workloads/hard_cases.h"

namespace radar::soak {

namespace {

using tools::Random;
using tools::operator*;

void aimAt(Query& query, const Transform& target) {
  double squares = 0;
  for (size_t k = 0; k < 3; ++k) {
    query.direction[k] = target.m[4 * k + 3] - query.worldFromMesh.m[4 * k + 3];
    squares += query.direction[k] * query.direction[k];
  }
  query.distance = std::sqrt(squares);
}

/// What is asked about the contact.
void setQuestion(Query& query, double size, bool isLarge, Random& random) {
  switch (random.below(8)) {
    case 0:
      query.anyHit = true;
      break;
    case 1:
      query.hits = 2 + random.below(3);
      break;
    case 2:
      query.hits = kAllHits;
      break;
    case 3:
      // Of large meshes a wide one would concern millions of pairs.
      query.clearance = random.magnitude(-8, isLarge ? -3 : 1) * size;
      if (random.oneIn(3)) query.tolerance = random.magnitude(-12, 0) * query.clearance;
      break;
    default:
      break;
  }
}

}  // namespace

Transform moved(Transform pose, double size, Random& random) {
  const tools::Vec3 step = random.oneIn(2) ? random.axis() : random.magnitude(-6, 0) * random.direction();
  for (size_t k = 0; k < 3; ++k) pose.m[4 * k + 3] += size * step[k];
  return pose;
}

Query varied(Query query, const Scene& scene, Random& random) {
  const double size = tools::sensorSize(scene, query);
  const ObjectId any = random.below(std::max(1u, scene.objectLimit()));
  if (random.oneIn(3)) query.worldFromMesh = moved(query.worldFromMesh, size, random);
  if (random.oneIn(4) && scene.hasObject(any)) aimAt(query, scene.object(any).worldFromMesh);
  if (random.oneIn(8)) query.distance *= random.oneIn(2) ? 0 : random.magnitude(-3, 3);
  if (random.oneIn(6) && query.distance > 0) tools::takeStep(query);
  setQuestion(query, size, scene.mesh(query.mesh).triangleCount() > 200, random);
  if (random.oneIn(5)) query.ignoreLeaving = !query.ignoreLeaving;
  if (random.oneIn(6)) query.skipOverlapping = !query.skipOverlapping;
  if ((query.ignoreLeaving || query.skipOverlapping) && random.oneIn(4)) query.slack = random.magnitude(-14, -3) * size;
  if (random.oneIn(6)) query.mask = random.oneIn(2) ? ~0u : 1u << random.below(32);
  if (random.oneIn(6)) query.exclude.push_back(any);
  std::erase_if(query.exclude, [&](ObjectId id) { return !scene.hasObject(id); });
  return query;
}

}  // namespace radar::soak
